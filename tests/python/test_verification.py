"""The quick runs of verification/, their certificates and the oracle, and the form of its cases."""

import multiprocessing
import re
from pathlib import Path

import pytest
from conftest import ROOT

import verify
from oracle.checks import broken
from runner import Study, all_folders, read
from stickslip.errors import Fault
from values import FUNCTIONS, evaluate

FOLDERS = [folder.name for folder in all_folders()]


@pytest.fixture(scope="module")
def studies(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Study]:
    """The studies of the quick runs of all cases."""
    output = tmp_path_factory.mktemp("verification")
    return {study.form.name: study for study in verify.verify((), output, quick=True)}


@pytest.fixture(scope="module")
def certificates(studies: dict[str, Study]) -> dict[tuple[str, str], set[str]]:
    """The checks of the certificate and of the oracle that do not hold, by case and run."""
    found = {(name, run): result for name, study in studies.items() for run, result in study.results.items()}
    # Closing a file looks at all objects that its process has open: forked ones would have those of all studies.
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        return dict(zip(found, pool.map(broken, [result.path for result in found.values()], chunksize=1)))


LOOSE = {"balance", "law", "equilibrium"}
"""Checks that need not hold where a deck asks for less than the bounds of the certificate."""

TOLERANCE = re.compile(r"^\*STICKSLIP.*TOLERANCE=\s*([^,\s]+)", re.MULTILINE)


@pytest.mark.parametrize("name", FOLDERS)
def test_the_certificates_of_the_quick_runs_hold(
    name: str, studies: dict[str, Study], certificates: dict[tuple[str, str], set[str]]
) -> None:
    wrong = {}
    for run, result in studies[name].results.items():
        asked = [float(tolerance) for tolerance in TOLERANCE.findall(result.deck)]
        allowed = LOOSE if max(asked, default=0.0) > 1e-10 else set()
        wrong[run] = certificates[name, run] - allowed
    assert {run: names for run, names in wrong.items() if names} == {}


@pytest.mark.parametrize("name", FOLDERS)
def test_the_quick_runs_of_a_case_give_its_references(name: str, studies: dict[str, Study]) -> None:
    study = studies[name]
    assert [(check.run, check.quantity, *check.shown()) for check in study.failures] == []
    assert len(study.checks) > 2 * len(study.runs)


def test_the_report_names_every_case_and_picture(studies: dict[str, Study]) -> None:
    text = verify.report(list(studies.values()))
    assert [name for name in FOLDERS if f"`{name}`" not in text] == []
    assert "FAIL" not in text


@pytest.mark.parametrize("name", FOLDERS)
def test_a_case_has_the_form(name: str) -> None:
    folder = ROOT / "verification" / name
    form = read(folder)
    readme = (folder / "README.md").read_text()
    assert readme.startswith(f"# {form.title}\n") and "```" in readme
    limits = [*form.quantities.values(), *form.curves, *form.orders]
    assert [limit.name for limit in limits if not limit.why] == []
    names = set(form.references)
    fixed = {limit.reference for limit in [*form.quantities.values(), *form.curves] if "{" not in limit.reference}
    assert fixed - {""} <= names
    runs = [run.name for run in form.runs]
    assert len(set(runs)) == len(runs) and any(run.quick for run in form.runs)


@pytest.mark.parametrize("name", FOLDERS)
def test_closed_forms_give_the_numbers_of_the_table(name: str) -> None:
    form = read(ROOT / "verification" / name)
    names = dict(FUNCTIONS)
    for key, text in form.constants.items():
        names[key] = evaluate(text, names) if isinstance(text, str) else text
    for key, reference in form.references.items():
        for k, formula in enumerate(reference.formulas):
            x = reference.x[k] if reference.x is not None else None
            if formula:
                value = float(reference.value[k])
                assert evaluate(formula, names | {"x": x}) == pytest.approx(value, rel=1e-6, abs=1e-12), key


def test_a_wrong_reference_fails(tmp_path: Path) -> None:
    form = read(ROOT / "verification" / "damping")
    run = next(run for run in form.runs if run.quick)
    study = Study(form, tmp_path, [run])
    study.take(run, *study.run(run))
    study.check("period / closed form", run.name, 1.002)
    study.check("period / closed form", run.name, 1.0005)
    study.check("period / closed form", run.name, float("nan"))
    assert [check.holds for check in study.checks] == [True, False, True, False]
    with pytest.raises(Fault, match="no case nonsense"):
        verify.forms(["nonsense"])
