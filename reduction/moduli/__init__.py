"""Stage: tangent, secant and segment moduli, and what follows from them."""
