"""Writes a result in the format of other programs.

vtu   JOB_0000.vtu and further files, one for each frame, and JOB.pvd, which names these files with their times (needs
      the package pyvista)
xdmf  JOB.xdmf: all frames as a series, which refers to the values in the result file
frd   JOB.frd: mesh, displacements and stresses at nodes of all frames, for the programs around CalculiX
csv   JOB.csv: all histories, a row for each increment
"""

import argparse
import csv
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from stickslip import frd, xdmf
from stickslip.convert import columns_of
from stickslip.errors import Fault
from stickslip.result import Result
from stickslip.whole import whole, write_text


def vtu(result: Result, folder: Path) -> Iterator[Path]:
    """Writes a file for every frame, and the file that lists these files."""
    entries = []
    for frame in result.frames:
        path = folder / f"{result.job}_{frame.index:04d}.vtu"
        with whole(path) as draft:
            frame.to_pyvista().save(draft)
        yield path
        entries.append(f'<DataSet timestep="{frame.time!r}" file="{path.name}"/>')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n'
    names = folder / f"{result.job}.pvd"
    write_text(names, head + "\n".join(entries) + "\n</Collection></VTKFile>\n")
    yield names


def histories(result: Result, folder: Path) -> Iterator[Path]:
    """Writes the table of all histories."""
    path = folder / f"{result.job}.csv"
    columns = columns_of(result)
    names = ["time", *(name for name in columns if name != "time")]
    with whole(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(names)
        table.writerows(zip(*(columns[name].tolist() for name in names)))
    yield path


def series(result: Result, folder: Path) -> Iterator[Path]:
    """Writes the XDMF text, which refers to the values of all frames."""
    yield _lines(folder / f"{result.job}.xdmf", xdmf.text_of(result, folder))


def of_calculix(result: Result, folder: Path) -> Iterator[Path]:
    """Writes all frames in the format of CalculiX."""
    yield _lines(folder / f"{result.job}.frd", frd.text_of(result))


def _lines(path: Path, lines: Iterable[str]) -> Path:
    """Writes a text line by line."""
    with whole(path) as draft, draft.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in lines)
    return path


FORMATS: dict[str, Callable[[Result, Path], Iterator[Path]]] = {
    "vtu": vtu,
    "xdmf": series,
    "frd": of_calculix,
    "csv": histories,
}


def run() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="stickslip export", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", type=Path, help="result file JOB.vtkhdf")
    parser.add_argument("--to", choices=FORMATS, required=True, help="format to write")
    parser.add_argument("-o", "--output", type=Path, help="folder to write into (default: that of the result)")
    arguments = parser.parse_args()
    with Result(arguments.result) as result:
        folder = arguments.output or result.path.parent
        if folder.exists() and not folder.is_dir():
            raise Fault(f"{folder} is no folder")
        written = list(FORMATS[arguments.to](result, folder))
    print(f"wrote {written[-1]}" if len(written) == 1 else f"wrote {written[-1]} and {len(written) - 1} more")
