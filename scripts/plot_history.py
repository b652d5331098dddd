"""Draws the histories of results: the command `stickslip-plot-history` of the package."""

from stickslip.plot.history import main

if __name__ == "__main__":
    main()
