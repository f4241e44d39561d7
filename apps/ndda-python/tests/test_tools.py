"""Studies, certificates, factors of safety, tests of joints, nets, pictures, results, the command."""

import json
import logging
import math
import os
import pathlib
import signal
import subprocess
import sys
import threading

import ndda
import numpy as np
import pytest

SCENES = pathlib.Path(__file__).resolve().parents[3] / "scenes"


def fall(**overrides: object) -> ndda.Scene:
    return ndda.parse(ndda.EXAMPLE, **overrides)


def command(*words: str, **keywords: object) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", "ndda", *words], capture_output=True, text=True, **keywords)


def test_a_study_gives_quantities_over_values() -> None:
    found = ndda.study(fall(), {"gravity_m_s2.2": [-1.0, -2.0]}, of=["block block.displacement_m"])
    assert [case["values"][0] for case in found["cases"]] == pytest.approx([0.5, 1.0], rel=1e-9)


def test_a_probability_comes_from_a_distribution(tmp_path: pathlib.Path) -> None:
    scene = fall(**{"output.history_rows": 1, "time.step_s": 0.25})
    vary = {"gravity_m_s2.2": "Uniform(-2, -1)"}
    found = ndda.study(scene, vary, fails_when="block block.displacement_m > 0.75", samples=40, out=tmp_path / "out")
    # ½ g exceeds ¾ for half of all g; a Latin hypercube leaves no chance to that.
    (written,) = (tmp_path / "out").glob("*.json")
    assert json.loads(written.read_text()) == found
    assert found["groups"][0]["failure"]["probability"] == pytest.approx(0.5, abs=1e-9)


def test_lines_go_to_logging_and_ctrl_c_ends_a_study(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "ndda")
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.4, lambda: signal.raise_signal(signal.SIGINT)).start()
    slow = fall(**{"time.end_s": 1e5, "gravity_m_s2": (0, 0, 0)})
    with pytest.raises(KeyboardInterrupt):
        ndda.study(slow, {"time.step_s": [0.01, 0.02, 0.04]}, of=["block block.displacement_m"])
    ndda.certify(fall())
    assert any("step_1" in record.getMessage() for record in caplog.records)


def test_a_certificate_bounds_the_closed_form() -> None:
    certificate = ndda.certify(ndda.load(SCENES / "bounce.ron", **{"time.end_s": 0.09}), of=["kinetic"])
    (found,) = (one for one in certificate["quantities"] if one["name"] == "kinetic_j")
    # ½ m g² t² of a cube of 1 m that falls.
    closed = 0.5 * 2650 * (9.8 * 0.09) ** 2
    assert abs(found["value"] - closed) <= found["error"] + 1e-12 * closed
    with pytest.raises(ValueError, match="no column of the history"):
        ndda.certify(fall(), of=["cube"])


def test_the_factor_of_safety_of_a_plane_is_that_of_limit_equilibrium(tmp_path: pathlib.Path) -> None:
    scene = ndda.load(SCENES / "safety/plane_slide.ron")
    found = ndda.safety(scene, error=0.2, out=tmp_path)
    bracket = found["factor_of_safety"]
    scene = scene.to_builder()
    # Limit equilibrium, as in the first lines of the scene.
    assert bracket["lower"] <= 1.158323 <= bracket["upper"] <= 1.25 * bracket["lower"]
    assert (tmp_path / "safety.json").exists() and scene.title == found["title"]
    with pytest.raises(ValueError, match="strength, load or gravity"):
        ndda.safety(ndda.load(SCENES / "safety/plane_slide.ron"), by="luck")


def test_a_joint_slides_at_its_friction() -> None:
    law = ndda.builders.Friction(friction_deg=30.0, shear_penalty_pa_m=1e10)
    test = ndda.joint.shear(law, normal_stress_pa=3e6, constant_volume=False)
    assert test.rows["shear_pa"][-1] == pytest.approx(3e6 * math.tan(math.radians(30)), rel=1e-9)
    closed = ndda.joint.closure(joint_stiffness_pa_m=20e9, max_closure_m=3e-4, normal_stress_pa=10e6)
    # Bandis: V = σ/(k + σ/V_m).
    assert closed.rows["closure_m"][-1] == pytest.approx(10e6 / (20e9 + 10e6 / 3e-4), rel=1e-6)
    with pytest.raises(ValueError, match="normal stress"):
        ndda.joint.shear(law, normal_stress_pa=-1.0)


def test_a_law_that_opens_by_slip_is_sheared_as_a_mapping_and_as_text() -> None:
    law = {"friction_deg": 30, "shear_penalty_pa_m": 1e10, "dilation": {"psi_deg": 10, "to_slip_m": 0.005}}
    text = "(friction_deg: 30, shear_penalty_pa_m: 1e10, dilation: (psi_deg: 10, to_slip_m: 0.005))"
    # Slip beyond the elastic displacement, up to 5 mm of it, opens the joint by tan 10°.
    for given in (law, text):
        test = ndda.joint.shear(given)
        assert test.rows["dilation_m"][-1] == pytest.approx(5e-3 * math.tan(math.radians(10)), rel=1e-6)
    with pytest.raises(ValueError, match="normal stiffness"):
        ndda.joint.shear(law, constant_volume=True)


def test_a_stereonet_checks_a_slope_and_is_a_picture(tmp_path: pathlib.Path) -> None:
    table = tmp_path / "joints.csv"
    table.write_text("dip_deg,dip_direction_deg,set\n45,150,a\n45,152,a\n80,10,b\n")
    found, picture = ndda.stereonet(table, slope="65/150", friction_deg=30)
    assert found["checks"]["plane_sliding"] == {"critical": 2, "of": 3}
    assert picture.content.startswith(b"<svg") and "image/svg+xml" in picture._repr_mimebundle_()
    with pytest.raises(ValueError, match="65/150"):
        ndda.stereonet(table, slope="steep")


def test_a_picture_of_a_scene_is_a_png() -> None:
    assert ndda.picture(fall(), size=(320, 240)).content.startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="iso, top"):
        ndda.picture(fall(), view="behind")


def test_results_are_tables_and_meshes(tmp_path: pathlib.Path) -> None:
    summary = ndda.run(fall(**{"output.frames": 4}), tmp_path / "fall")
    results = ndda.read(tmp_path / "fall")
    assert results.summary == summary and results.times == pytest.approx([0, 0.25, 0.5, 0.75, 1.0])
    page = results.show()
    assert page.frames == 5 and "<iframe" in page._repr_html_()
    pandas = pytest.importorskip("pandas")
    assert isinstance(results.history, pandas.DataFrame) and results.history["time_s"].iloc[-1] == 1.0
    with pytest.raises(FileNotFoundError, match="output.contacts"):
        _ = results.contacts
    meshio = pytest.importorskip("meshio")
    mesh = results.mesh(0.5)
    assert isinstance(mesh, meshio.Mesh)
    assert mesh.point_data["displacement_m"][:, 2] == pytest.approx(-0.5 * 9.81 * 0.25, rel=1e-6)


def test_arguments_that_make_no_sense_are_refused_in_words() -> None:
    simulation = ndda.Simulation(fall())
    for until in (math.nan, math.inf):
        with pytest.raises(ValueError, match="give a time"):
            simulation.run(until=until)
    with pytest.raises(ValueError, match="at least 0"):
        simulation.run(frames=-1)
    with pytest.raises(TypeError, match="is not a scene"):
        ndda.Simulation(3)
    with pytest.raises(TypeError, match="function of facets"):
        ndda.Simulation(fall(), law=3)
    with pytest.raises(ValueError, match="nothing varies"):
        ndda.study(fall())
    with pytest.raises(ndda.SceneError, match="unreadable"):
        ndda.certify("no_such_scene.ron")


def test_rows_of_arrays_are_vectors_of_a_scene() -> None:
    simulation = ndda.Simulation(fall(gravity_m_s2=np.array([0.0, 0.0, -1.0])))
    simulation.run()
    simulation.change(**{"time.end_s": np.float64(2.0)})
    assert simulation.velocity[:, 2] == pytest.approx(-1.0, rel=1e-9) and simulation.steps == 200


def test_runs_are_not_replaced_unless_told(tmp_path: pathlib.Path) -> None:
    ndda.run(fall(), tmp_path / "fall")
    with pytest.raises(OSError, match="fall"):
        ndda.run(fall(), tmp_path / "fall")
    ndda.run(fall(), tmp_path / "fall", force=True)


def test_the_page_of_a_simulation_has_its_frames(tmp_path: pathlib.Path) -> None:
    simulation = ndda.Simulation(fall(title='"</script><b>"'))
    simulation.run(frames=3)
    simulation.keep_frame()
    page = simulation.show()
    assert page.frames == 4 and page.html.count("<script") == page.html.count("</script>")
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html


def test_a_history_has_the_rows_of_a_run() -> None:
    simulation = ndda.Simulation(fall())
    simulation.run()
    history = simulation.history
    assert len(history) == 101 and abs(history["balance_j"]).max() < 1e-6
    assert history["kinetic_j"] == pytest.approx(0.5 * 2600 * (9.81 * history["time_s"]) ** 2, rel=1e-9)
    with pytest.raises(ValueError, match="no column"):
        simulation.plot("speed_m_s")


def test_energies_are_drawn() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    simulation = ndda.Simulation(fall())
    simulation.run()
    axes = simulation.plot()
    assert [line.get_label() for line in axes.get_lines()][:2] == ["kinetic", "load"]


def test_the_command_runs_checks_and_says_what_is_wrong(tmp_path: pathlib.Path) -> None:
    (tmp_path / "fall.ron").write_text(ndda.EXAMPLE)
    ran = command("run", "fall.ron", "--out", "out", "--quiet", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert json.loads((tmp_path / "out/summary.json").read_text())["state_crc32"] == ndda.run(fall())["state_crc32"]
    assert command("check", "no.ron", cwd=tmp_path).returncode == 3
    assert command("no-such-verb").returncode == 2
    assert ndda.__version__ in command("--version").stdout
    # Its cases are processes of the command.
    study = ["study", "fall.ron", "--vary", "time.step_s=0.01,0.02", "--of", "block block.displacement_m"]
    assert command(*study, "--out", "study", cwd=tmp_path).returncode == 0


def test_ctrl_c_ends_the_command_after_a_step(tmp_path: pathlib.Path) -> None:
    text = ndda.EXAMPLE.replace("end_s: 1.0", "end_s: 1e7").replace("-9.81", "0")
    (tmp_path / "endless.ron").write_text(text)
    words = [sys.executable, "-m", "ndda", "run", "endless.ron", "--out", "out", "--quiet"]
    running = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.DEVNULL)
    while not (tmp_path / "out/history.csv").exists():
        assert running.poll() is None
    running.send_signal(signal.SIGINT)
    assert running.wait(20) == 130
    assert json.loads((tmp_path / "out/summary.json").read_text())["status"] == "interrupted"


def test_what_is_imported_later_is_there() -> None:
    for name in ndda.__all__:
        assert getattr(ndda, name) is not None
    assert set(ndda.__all__) <= set(dir(ndda))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = ndda.nothing
    code = "import sys, ndda; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], env=os.environ).returncode == 0


EARTHQUAKE = SCENES / "works" / "slope_earthquake.ron"


def named_files(folder: pathlib.Path) -> ndda.Scene:
    """A scene whose material is in a file of another folder."""
    folder.mkdir()
    (folder / "rock.ron").write_text('[(name: "rock", density_kg_m3: 2600, young_pa: 1e9, poisson: 0.25)]')
    text = ndda.EXAMPLE
    start, end = text.index("materials: ["), text.index("blocks: [")
    return ndda.parse(f'{text[:start]}include: ["rock.ron"],\n    {text[end:]}', folder=folder)


def test_tools_find_the_files_of_a_scene_that_is_a_text_or_was_changed(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = named_files(tmp_path / "scenes")
    # The working folder is another one.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes" / "fall.ron").write_text(scene.text)
    changed = ndda.load(pathlib.Path("scenes") / "fall.ron", **{"time.end_s": 0.5})
    for one, depth in ((scene, 4.905), (changed, 4.905 / 4)):
        found = ndda.study(one, {"time.step_s": [0.01, 0.02]}, of="block block.displacement_m")
        assert [case["values"][0] for case in found["cases"]] == pytest.approx([depth, depth], rel=1e-6)
        assert ndda.picture(one, size=(300, 200)).kind == "png"
        assert ndda.certify(one)["schema"].startswith("ndda.certificate")
    assert ndda.Simulation(changed).scene.folder == changed.folder


def test_an_earthquake_of_a_changed_scene_is_found() -> None:
    scene = ndda.load(EARTHQUAKE, **{"time.end_s": 0.001})
    found = ndda.study(scene, {"contact.friction.friction_deg": [30.0]}, of="kinetic_j", second_runs="never")
    assert found["cases"][0].get("reason") is None and ndda.picture(scene, size=(300, 200)).kind == "png"


def test_a_study_whose_cases_all_fail_gives_the_first_reason() -> None:
    with pytest.raises(ValueError, match="all cases of the study have failed, 2 of 2; the first, .*density"):
        ndda.study(fall(), {"materials.0.density_kg_m3": [-1.0, -2.0]}, of="block block.displacement_m")
