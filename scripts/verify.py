"""Runs the cases of verification/, side by side, checks and draws them, writes the report."""

import argparse
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import matplotlib
from repository import ROOT
from stickslip.errors import Fault

matplotlib.use("Agg")
sys.path.insert(0, str(ROOT / "verification"))

from runner import Check, Form, Study, all_folders, markdown, read  # noqa: E402
from pictures import draw  # noqa: E402

HEADER = ("case", "quantity", "reference", "computed", "error", "tolerance", "verdict", "increments", "seconds")


def verify(
    names: Sequence[str], output: Path, quick: bool = False, jobs: int = 2, reuse: bool = False
) -> list[Study]:
    """Runs and checks cases (all without names); their studies, evaluated."""
    studies = [
        Study(form, output / form.name, [run for run in form.runs if run.quick or not quick], reuse, not quick)
        for form in forms(names)
    ]
    studies = [study for study in studies if study.runs]
    left = {id(study): len(study.runs) for study in studies}
    count, start, done = sum(left.values()), time.monotonic(), 0
    with ThreadPoolExecutor(jobs) as pool:
        work = {pool.submit(study.run, run): (study, run) for study in studies for run in study.runs}
        found: dict[int, dict[str, tuple[Path | None, int]]] = {}
        for future in as_completed(work):
            study, run = work[future]
            done += 1
            found.setdefault(id(study), {})[run.name] = future.result()
            left[id(study)] -= 1
            if left[id(study)] > 0:
                continue
            for each in study.runs:
                study.take(each, *found[id(study)][each.name])
            study.evaluate()
            study.finish()
            seconds = time.monotonic() - start
            failed = len(study.failures)
            verdict = f"{failed} of {len(study.checks)} checks FAIL" if failed else f"{len(study.checks)} checks"
            print(f"[{seconds:5.0f} s, {done}/{count} runs] {study.form.name}: {verdict}", flush=True)
            for check in study.failures:
                reference, computed, _, bound = check.shown()
                print(f"    {check.run}: {check.quantity}: {computed}, not {reference} {bound}")
    return studies


def forms(names: Sequence[str]) -> list[Form]:
    """The cases of these names, or all; a Fault names one that does not exist."""
    folders = {folder.name: folder for folder in all_folders()}
    for name in names:
        if name not in folders:
            raise Fault(f"there is no case {name}; there are {', '.join(folders)}")
    return [read(folders[name]) for name in names or folders]


def rows_of(study: Study) -> list[tuple[str, ...]]:
    """The rows of a case: every value with a reference; of bounds the run that is nearest to it."""
    rows = []
    nearest: dict[str, Check] = {}
    count: dict[str, int] = {}
    for check in study.checks:
        if check.reference is None and check.holds:
            count[check.quantity] = count.get(check.quantity, 0) + 1
            best = nearest.get(check.quantity)
            if best is None or check.part > best.part:
                nearest[check.quantity] = check
    for check in study.checks:
        worst = nearest.get(check.quantity) is check
        if check.common and check.holds or check.reference is None and check.holds and not worst:
            continue
        of = f" (worst of {count[check.quantity]})" if worst and count[check.quantity] > 1 else ""
        verdict = "pass" if check.holds else "**FAIL**"
        tail = (verdict, study.increments(check.run), study.seconds(check.run))
        rows.append((f"{study.form.name}/{check.run}", check.quantity + of, *check.shown(), *tail))
    return rows


def report(studies: Sequence[Study]) -> str:
    """The report of cases."""
    checks = [check for study in studies for check in study.checks]
    failed = [check for check in checks if not check.holds]
    orders = [
        (study.form.name, check.quantity, f"{check.computed:.2f}", f">= {check.limit.at_least:g}", check.limit.why)
        for study in studies
        for order in study.form.orders
        for check in study.checks
        if check.quantity == order.name
    ]
    runs = sum(len(study.runs) for study in studies)
    parts = [
        "# Verification: computed beside references\n",
        "`scripts/verify` writes this page. README.md tells what the columns mean; the folder of each case has its"
        " sketch, the source of its references and the reason for each tolerance.\n",
        f"{len(studies)} cases, {runs} runs, {len(checks)} checks, {len(failed)} failed;"
        f" {sum(check.common for check in checks)} of the checks are those of `limits.toml`, which every run has to"
        " pass; they are listed only where they fail.\n",
    ]
    if orders:
        parts += ["## Observed orders of convergence\n", markdown(("case", "error", "order", "at least", "why"), orders)]
    for study in studies:
        known = {row.tag: None for row in study.form.references.values()}
        tags = f" References: {', '.join(known)}." if known else ""
        parts.append(f"## [{study.form.title}]({study.form.name}/README.md)\n\n`{study.form.name}`.{tags}\n")
        if (study.form.folder / "picture.png").exists():
            parts.append(f"![{study.form.title}]({study.form.name}/picture.png)\n")
        parts.append(markdown(HEADER, rows_of(study)))
    return "\n".join(parts)


def main() -> int:
    """Reads the command line, runs, reports; the exit code is 1 when a check fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("case", nargs="*", help="names of folders; all without any")
    parser.add_argument("--quick", action="store_true", help="only the short runs")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (2)")
    parser.add_argument("--reuse", action="store_true", help="keep results that exist")
    arguments = parser.parse_args()
    output = ROOT / "results" / "verification" / ("quick" if arguments.quick else "")
    try:
        studies = verify(arguments.case, output, arguments.quick, arguments.jobs, arguments.reuse)
    except Fault as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    whole = not arguments.case and not arguments.quick
    for study in studies:
        place = study.form.folder if not arguments.quick else study.output
        draw(study, place / "picture.png")
    path = (ROOT / "verification" if whole else output) / "REPORT.md"
    path.write_text(report(studies))
    failed = sum(len(study.failures) for study in studies)
    print(f"{sum(len(study.checks) for study in studies)} checks, {failed} failed; wrote {path}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
