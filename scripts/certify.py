"""Checks what results claim: the command `stickslip-certify` of the package."""

from stickslip.certificate.__main__ import main

if __name__ == "__main__":
    main()
