"""Tables and figures of a report page, as they are before they become HTML."""

import numpy as np


def texts(table):
    return [[cell.text for cell in row] for row in table.rows]


def column(table, heading):
    place = next(i for i, name in enumerate(table.columns) if name.startswith(heading))
    return [row[place].text for row in table.rows]


def traces(figure):
    return {trace["name"]: trace for trace in figure.data}


def numbers(values):
    return np.array([np.nan if one is None else one for one in values])
