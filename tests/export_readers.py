"""Small readers of what is exported, written from the grammars and not from the writers."""

import re

import numpy as np
import yaml


def moordyn_table(text):
    """Three header lines, rows of two numbers with one blank, nothing after the last one."""
    assert not text.endswith("\n")
    rows = [row.split(" ") for row in text.split("\n")[3:]]
    assert all(len(row) == 2 for row in rows)
    assert 2 <= len(rows) <= 30
    return np.array(rows, dtype=float).T


def moordyn_sections(text):
    """Rows of each section of a deck, without its two lines of headings."""
    parts = re.split(r"^-{3,} *(.*?) *-{3,}$", text, flags=re.MULTILINE)
    assert not re.search(r"[#!%]|---", parts[0])
    sections = {}
    for name, body in zip(parts[1::2], parts[2::2], strict=True):
        rows = [row.split() for row in body.strip("\n").split("\n")]
        sections[name] = rows if name in ("OPTIONS", "OUTPUTS") else rows[2:]
    return sections


def moorpy_table(text):
    """As MoorPy reads it: rows after three lines, up to one with three dashes, then nothing."""
    lines = iter(text.split("\n"))
    for _ in range(3):
        next(lines)
    rows = []
    while "---" not in (line := next(lines)):
        rows.append(line.split())
    assert list(lines) == []
    return np.array(rows, dtype=float).T


def cable_material(text):
    """Name and assignments of the first material; expressions are left as text."""
    body = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    section, end = re.search(r"^Materials\n(.*)^(End)$", body, re.MULTILINE | re.DOTALL).groups()
    assert end == "End"
    rows = [row.strip() for row in section.split("\n") if row.strip()]
    return rows[0].strip('"'), dict(row.split(" = ", 1) for row in rows[1:])


def cable_pairs(text):
    pairs = re.findall(r"\(([^,()]+), ([^,()]+)\)", text)
    return np.array(pairs, dtype=float).T


class CableExpression:
    """Value of an expression of ``e``: ?: < + - * and parentheses; every number has a point."""

    def __init__(self, text):
        self.tokens = re.findall(r"\d+\.\d*(?:e[+-]?\d+)?|e|[()?:<+*-]", text)
        assert "".join(self.tokens) == text.replace(" ", "")
        self.place = 0
        self.run = self._choice()
        assert self.place == len(self.tokens)

    def __call__(self, strain):
        return np.array([self.run(float(e)) for e in np.atleast_1d(strain)])

    def _next(self):
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def _take(self, token):
        assert self._next() == token, (self._next(), token)
        self.place += 1

    def _choice(self):
        left = self._sum()
        if self._next() == "<":
            self._take("<")
            low, high = left, self._sum()
            left = lambda e: float(low(e) < high(e))  # noqa: E731
        if self._next() != "?":
            return left
        self._take("?")
        yes = self._choice()
        self._take(":")
        no = self._choice()
        return lambda e: yes(e) if left(e) else no(e)

    def _sum(self):
        value = self._product()
        while self._next() in ("+", "-"):
            sign = 1 if self._next() == "+" else -1
            self.place += 1
            value = (lambda a, b, s: lambda e: a(e) + s * b(e))(value, self._product(), sign)
        return value

    def _product(self):
        value = self._factor()
        while self._next() == "*":
            self._take("*")
            value = (lambda a, b: lambda e: a(e) * b(e))(value, self._factor())
        return value

    def _factor(self):
        sign = self._next()
        self.place += 1
        if sign == "(":
            inner = self._choice()
            self._take(")")
            return inner
        if sign == "-":
            inner = self._factor()
            return lambda e: -inner(e)
        if sign == "e":
            return lambda e: e
        number = float(sign)
        return lambda e: number


def orcaflex(text):
    """Line type and its table in SI; the head is that of a text data file."""
    assert text.startswith("%YAML 1.1\n# Type: Model\n# Program: OrcaFlex")
    document = yaml.safe_load(text)
    assert document["General"] == {"UnitsSystem": "SI"}
    (table,) = document["VariableData"]["Axialstiffness"]
    (line,) = document["LineTypes"]
    assert line["EA"] == table["Name"]
    strain, tension = np.array(table["IndependentValue, DependentValue"], dtype=float).T
    return line, strain, 1e3 * tension


def abaqus(text):
    """Stress and strain of the uniaxial test data; comments begin with two stars."""
    rows = [row for row in text.split("\n") if row and not row.startswith("**")]
    assert rows[0].startswith("*MATERIAL, NAME=")
    assert rows[1:3] == ["*HYPERELASTIC, MARLOW", "*UNIAXIAL TEST DATA"]
    return np.array([row.split(", ") for row in rows[3:]], dtype=float).T
