"""Files that go wrong while the app takes and reads them: what a person sees."""

import asyncio
import errno
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from tests.trial_soles import step, step_bars
from web_app import COARSE, begin, drawn, page_of, project_of, served

from outsole_bodies import grooved, heel_body, triangles, write_stl

pytest.importorskip("nicegui")

from underfoot.app import work, work_sole
from underfoot.app.pages import sole_file
from underfoot.app.project import Project
from underfoot.app.uploads import receive_file
from underfoot.case import Case
from underfoot.core import InputError, silent
from underfoot.report.outsole import case_text, inspect_outsole
from underfoot.shoe.files import FileSettings

SOLES = "input[type=file][accept*=stl]"


async def pieces(data, size=1000):
    for start in range(0, len(data), size):
        yield data[start : start + size]


@pytest.mark.slow
def test_a_file_that_changes_while_it_is_read_is_told(tmp_path, monkeypatch):
    sole = write_stl(tmp_path / "sole.stl", triangles(heel_body(grooved(pitch=10e-3))))
    read = work_sole.read_mesh

    def read_then_written(*args):
        mesh = read(*args)
        sole.write_bytes(sole.read_bytes() + b"more")
        return mesh

    monkeypatch.setattr(work_sole, "read_mesh", read_then_written)
    with pytest.raises(InputError, match="the file changed while it was read"):
        work_sole.inspected_sole(str(sole), {}, progress=silent)


def test_a_full_disk_leaves_no_part_of_a_file(tmp_path, monkeypatch):
    project, opened = Project(tmp_path / "project"), Path.open

    class Full:
        def __init__(self, stream):
            self.stream = stream

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.stream.close()

        def write(self, data):
            if self.stream.tell() + len(data) > 4000:
                raise OSError(errno.ENOSPC, "No space left on device", self.stream.name)
            return self.stream.write(data)

    def limited(path, mode="r", *args, **options):
        stream = opened(path, mode, *args, **options)
        return Full(stream) if mode == "wb" else stream

    monkeypatch.setattr(Path, "open", limited)
    with pytest.raises(OSError, match=r"No space left.*soles.big\.stl"):
        asyncio.run(receive_file(project, "soles/big.stl", pieces(bytes(9000))))
    assert list((project.folder / "soles").iterdir()) == []
    asyncio.run(receive_file(project, "soles/small.stl", pieces(bytes(3000))))
    assert [path.name for path in (project.folder / "soles").iterdir()] == ["small.stl"]


def test_names_of_two_hundred_letters_are_refused_before_they_are_written(tmp_path):
    project = Project(tmp_path / "project")
    long = "a" * 200
    with pytest.raises(InputError, match="can't be the name of a file on every system"):
        asyncio.run(receive_file(project, f"soles/{long}.stl", pieces(b"x")))
    with pytest.raises(InputError, match="is no name"):
        project.add(long, "")
    assert len(project.free_name(long)) <= 60
    assert list((project.folder / "soles").iterdir()) == []


@pytest.fixture
def small_disk(tmp_path):
    """A folder with 8 MB of room."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = ["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", str(folder)]
    try:
        subprocess.run(mounted, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        # mounting takes root, which a desk seldom gives
        pytest.skip("no small disk can be mounted here")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


@pytest.mark.browser
@pytest.mark.slow
def test_a_person_on_a_full_disk_reads_so_and_goes_on_with_room(small_disk, tmp_path):
    big, sole = tmp_path / "big.stl", tmp_path / ("b" * 200 + ".stl")
    big.write_bytes(bytes(9_000_000))
    write_stl(sole, triangles(heel_body(grooved(pitch=10e-3))))
    project = project_of(small_disk / "project", "heel")
    folder = project.result_folder("heel")
    work.computed(str(project.path("heel")), str(folder), progress=silent)
    sizes = {path.name: path.stat().st_size for path in folder.iterdir()}
    shutil.rmtree(folder)
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "design?variant=heel")
        drawn(page)
        page.locator(SOLES).set_input_files(big)
        page.locator(".drop-state", has_text="no space left on the disk").wait_for()
        page.locator(SOLES).set_input_files(sole)
        page.locator(".drop-state", has_text="can't be the name of a file").wait_for()
        room = small_disk / "room"
        room.write_bytes(bytes(shutil.disk_usage(small_disk).free))
        page.locator("input[name='shoe.tread.depth']").press("ArrowRight")
        page.locator("[data-part=problem]", has_text="no space left on the disk").wait_for()
        assert project.case("heel").value("shoe.tread.depth") == pytest.approx(3e-3)
        room.unlink()
        page.wait_for_function("!document.querySelector('[data-part=problem]').textContent")
        assert project.case("heel").value("shoe.tread.depth") == pytest.approx(3.1e-3)
        enough = sum(sizes.values()) - sizes["report.html"] // 2  # the result fits, not its page
        room.write_bytes(bytes(shutil.disk_usage(small_disk).free - enough))
        page.get_by_role("button", name="Compute friction").click()
        page.wait_for_selector(".big")
        page.get_by_text("report.html could not be written").wait_for()
        room.unlink()
        page.get_by_role("button", name="Compute friction").click()
        page.get_by_text("report.html could not be written").wait_for(state="detached")
        page.wait_for_selector(".big")


@pytest.mark.browser
@pytest.mark.slow
def test_a_project_that_can_only_be_read_says_so_and_goes_on(small_disk, tmp_path):
    project = project_of(small_disk / "project", "heel")
    sole = write_stl(tmp_path / "sole.stl", triangles(heel_body(grooved(pitch=10e-3))))
    before = project.path("heel").read_bytes()

    def mount(kind):
        again = ["mount", "-o", f"remount,{kind}", str(small_disk)]
        subprocess.run(again, check=True, capture_output=True)

    mount("ro")
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        said = page.locator(".problem", has_text="the disk is read-only")
        page.goto(app.base + "design?variant=heel")
        drawn(page)
        page.locator("input[name='shoe.tread.depth']").press("ArrowRight")
        page.locator("[data-part=problem]", has_text="the disk is read-only").wait_for()
        page.locator(SOLES).set_input_files(sole)
        page.locator(".drop-state", has_text="sole.stl can't be written").wait_for()
        page.get_by_role("tab", name="Spill").click()
        field = page.get_by_label("Viscosity", exact=True)
        field.fill("55")
        field.press("Enter")
        said.first.wait_for()
        assert field.input_value() == "55"
        page.get_by_role("button", name="More for this variant").click()
        page.locator(".q-menu .q-item", has_text="Copy").click()
        said.nth(1).wait_for()
        page.get_by_role("button", name="Compute friction").click()
        page.get_by_text("nothing can be written").wait_for()
        page.get_by_text("has not been computed yet").wait_for()
        assert project.path("heel").read_bytes() == before
        mount("rw")
        page.get_by_role("button", name="Compute friction").click()
        page.wait_for_selector(".big")
        assert app.process.poll() is None


@pytest.mark.browser
@pytest.mark.slow
def test_a_sole_that_vanishes_while_it_is_used_is_told_and_comes_back(tmp_path):
    project = project_of(tmp_path / "project", "heel")
    sole = write_stl(tmp_path / "sole.stl", triangles(heel_body(grooved(pitch=10e-3))))
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "design?variant=heel")
        drawn(page)
        page.locator(SOLES).set_input_files(sole)
        page.get_by_role("button", name="Use this sole").click()
        page.get_by_text("The sole comes from sole.stl").wait_for()
        kept = project.folder / "soles" / "sole.stl"
        page.get_by_role("button", name="Compute friction").click()
        page.get_by_role("button", name="Stop").first.wait_for()
        kept.rename(tmp_path / "away.stl")  # in the run or before it: said, or the run is done
        page.get_by_text("can't be read").or_(page.locator(".problem")).first.wait_for()
        page.goto(app.base + "design?variant=heel")
        page.get_by_text("This variant can't be read").wait_for()
        (tmp_path / "away.stl").rename(kept)
        page.goto(app.base + "design?variant=heel")
        page.get_by_text("The sole comes from sole.stl").wait_for()
        drawn(page)
        assert app.process.poll() is None


@pytest.mark.browser
@pytest.mark.slow
def test_reading_a_step_file_shows_progress_and_stops_beside_sliders(tmp_path):
    file = step(step_bars)(tmp_path)
    with served(tmp_path / "project", tmp_path / "home") as app, page_of(app.link) as page:
        begin(page, app.base)
        page.locator(SOLES).set_input_files(file)
        line = page.locator(".task", has_text="reading the file")
        line.wait_for()
        assert line.get_by_role("progressbar").count() == 1

        def meshers():
            children = psutil.Process(app.process.pid).children(recursive=True)
            return [each for each in children if "mesh_into" in " ".join(each.cmdline())]

        page.wait_for_timeout(200)
        line.get_by_role("button", name="Stop").click()
        page.get_by_text("Reading was stopped").wait_for()
        _, alive = psutil.wait_procs(meshers(), timeout=60)
        assert not alive
        page.get_by_role("button", name="Read it again").click()
        page.get_by_role("button", name="Use this sole", exact=True).wait_for()
        drawn(page)
        assert page.complaints == []


def test_of_the_shoe_that_gave_way_only_what_a_person_set_stays(tmp_path):
    project = project_of(tmp_path / "project", "heel")
    project.change("heel", {"shoe.material.shore_a": 65.0, "shoe.tread.depth": "2 mm"})
    case = project.take_sole("heel", {"from": "athletic_shoe_untreaded"})
    plain = project.case("heel").replace("shoe", {"from": "athletic_shoe_untreaded"})
    given = {path for path, origin in case.origins.items() if origin.kind == "given"}
    before = {path for path, origin in plain.origins.items() if origin.kind == "given"}
    assert given - before == {"shoe.material.shore_a"}
    assert case.value("shoe.material.shore_a") == 65.0
    assert case.value("shoe.tread.depth") == plain.value("shoe.tread.depth")


def test_a_file_in_the_app_is_the_case_that_inspect_writes(tmp_path):
    """What a person set before stays; nothing of the shoe begun with does."""
    own = {"shoe.material.shore_a": 65.0, "shoe.wear.depth": 1e-3}
    project = project_of(tmp_path / "project", "heel")
    project.change("heel", own)
    file = write_stl(
        project.folder / "soles" / "bars.stl", triangles(heel_body(grooved(pitch=10e-3)))
    )
    session = SimpleNamespace(project=project)
    page = SimpleNamespace(session=session, path="soles/bars.stl", settings={})
    variants = str(project.inside("variants"))
    answer = work_sole.inspected_sole(str(file), {}, variants, progress=silent)
    sole_file._Inspection._use(page, ["heel"], answer["shoe"])
    text = case_text(inspect_outsole(file, FileSettings()), project.folder / "variants")
    by_command = project.folder / "variants" / "command.toml"
    by_command.write_text(text)
    expected = Case.load(by_command).replace({**COARSE, **own})
    assert project.case("heel").hash == expected.hash
    assert project.case("heel").value("shoe.sole.midsole.thickness") == pytest.approx(15e-3)
    project.undo("heel")
    assert project.case("heel").shoe.outsole is None
