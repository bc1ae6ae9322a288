"""The way of the data: a record in SI to a reduced test.  Pure: no file, no clock."""
