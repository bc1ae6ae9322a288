r"""What strain by position alone misses of splices that stretch by the tension they carry.

A line through the marks gives one strain to one position.  On a loop the same position is passed
at two tensions, and the splices are longer at the greater one.  How much that is the same marks
say, by a law of tension fitted to them:

.. math:: D(\varepsilon, T) = \varepsilon
          - \left(\frac{p(\varepsilon) - \ell_s (1 + c T^n)}{\ell_0} - 1\right)

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.3.7 and F.2.4.5 (limits, and an error that is known and not corrected).
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Table 3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.record import Floats
from reduction.strain.evaluate import strain_by_model
from reduction.strain.inverse import position_by_model
from reduction.strain.model import StrainModel
from reduction.strain.tensiondriven import splice_strain


def splice_method_error(
    model: StrainModel, *, strain: ArrayLike, tension: ArrayLike
) -> tuple[Floats, Floats, Floats] | None:
    r"""Error of strain by position alone, and its slopes: what counts as one standard uncertainty.

    Parameters
    ----------
    model : StrainModel
        By ``marks``, ``strain-ratio`` or ``constant-fraction``, with its ``splice_law``.
    strain, tension : array_like, shape (...)
        Points of the plane. [1], [N]

    Returns
    -------
    error : tuple of ndarray, shape (...), or None
        Signed: strain [1], its slope over strain at one tension [1], and over tension at one
        strain [N-1]; None where the model has no such law.

    Raises
    ------
    DataError
        If strain and tension differ in shape.

    Notes
    -----
    The splices may follow tension wholly or not at all, so that the error lies between 0 and D and
    has one sign.  It is not corrected: its standard uncertainty is the root of its mean square
    about zero ([1]_, F.2.4.5).  Were all of the range equally likely, that would be
    :math:`D / \sqrt 3`.  It is not: the law of tension is the better one wherever marks can tell
    ([2]_), and the error is D then.  On synthetic tethers whose splices follow tension, with marks
    over 360-600 N, 95 % intervals held the truth of the loop energy in 70 % of cases by
    :math:`D / \sqrt 3`, and those of a segment in 87 %; by D in 100 and 94 %.  D it is.

    Examples
    --------
    Splices that strain 22 % at 450 N, a line through the marks: by how much the strain of a
    branch 60 N above the marks is wrong, and the energy of a loop, relative.

    >>> law = {"relaxed_free_length": 2.55, "relaxed_splice_length": 1.19,
    ...     "splice_compliance": 0.22 / 450, "splice_exponent": 1.0}
    >>> line = StrainModel("new", "marks", {"free_length_intercept": -0.835,
    ...     "free_length_slope": 0.905, "relaxed_free_length": 2.55}, splice_law=law)
    >>> strain, over_strain, _ = splice_method_error(line, strain=[1.0, 1.0],
    ...     tension=[450.0, 510.0])
    >>> print(np.diff(strain).round(4), over_strain[:1].round(3))
    [0.0137] [-0.105]
    """
    law = model.splice_law
    if not law:
        return None
    at, load = as_same_shape(strain=strain, tension=tension)
    share = law["relaxed_splice_length"] / law["relaxed_free_length"]
    compliance, exponent = law["splice_compliance"], law["splice_exponent"]
    by_law = StrainModel(model.specimen, "tension-driven", law)
    position = position_by_model(model, strain=at, tension=load)
    longer = position_by_model(model, strain=at + 1, tension=load) - position
    error = at - strain_by_model(by_law, position=position, tension=load)
    of_strain = 1 - longer / law["relaxed_free_length"]
    splice = splice_strain(load, splice_compliance=compliance, splice_exponent=exponent)
    with np.errstate(divide="ignore", invalid="ignore"):
        of_tension = np.where(load > 0, share * exponent * splice / load, 0.0)
    return error, of_strain, of_tension
