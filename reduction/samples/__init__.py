"""Series of samples of a record: where they lie, and how stages go over them."""
