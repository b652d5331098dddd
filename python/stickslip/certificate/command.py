"""Checks the claims of a result file about contacts, energies and momenta, from the file alone (docs/certificate.md).

The exit code is 0 if all checks hold, 1 if one fails, and 2 if the file cannot be read.
"""

import argparse
from pathlib import Path

from stickslip.certificate.certify import certify
from stickslip.certificate.own import write_table
from stickslip.result import Result


def run() -> int:
    """Certifies the results of the command line."""
    parser = argparse.ArgumentParser(
        prog="stickslip certify",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="write what the run has checked itself, one row for each increment (one result only)",
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="one line for each file")
    arguments = parser.parse_args()
    if arguments.table and len(arguments.result) > 1:
        parser.error("--table takes one result")
    holds = True
    for path in arguments.result:
        with Result(path) as result:
            found = certify(result)
            if arguments.table:
                write_table(result, arguments.table)
        holds &= found.holds
        print(f"{found.job}: {found.line}")
        if not arguments.quiet:
            print("\n".join(found.table()))
    return 0 if holds else 1
