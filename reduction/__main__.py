"""``python -m reduction``, the same as the console script."""

from reduction.cli.main import app

if __name__ == "__main__":
    app(prog_name="reduction")
