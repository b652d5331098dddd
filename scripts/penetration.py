"""Looks for nodes inside bodies: the command `stickslip-penetration` of the package."""

from stickslip.penetration.intrusion import main

if __name__ == "__main__":
    main()
