"""Draws a field along a line of nodes: the command `stickslip-plot-along` of the package."""

from stickslip.plot.along import main

if __name__ == "__main__":
    main()
