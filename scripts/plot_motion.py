"""Draws the motion of results: the command `stickslip-plot-motion` of the package."""

from stickslip.plot.motion import main

if __name__ == "__main__":
    main()
