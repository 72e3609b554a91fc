from cases.results.files import write_whole
from cases.run import keys
from cases.run.keys import content_key, import_closure, key_parts
from tests.cases.fake_case import FAST, fake_case, spoiled


def parts(case):
    return key_parts(next(iter(case.tasks())))


def test_equal_tasks_have_equal_keys():
    assert content_key(parts(fake_case())) == content_key(parts(fake_case()))


def test_settings_change_the_key():
    old, new = parts(fake_case()), parts(fake_case(fast=spoiled(FAST, cell=0.5)))
    assert content_key(old) != content_key(new)
    assert (old["settings"]["cell"], new["settings"]["cell"]) == (0.0, 0.5)


def test_the_last_bit_of_a_scene_changes_the_key():
    old = parts(fake_case())
    new = {**old, "scene": {**old["scene"], "layer": {**old["scene"]["layer"], "poissons_ratio": 0.3 + 1e-16 * 2}}}
    assert content_key(old) != content_key(new)
    assert old["scene"]["layer"]["poissons_ratio"] != new["scene"]["layer"]["poissons_ratio"]


def test_the_closure_holds_what_a_method_can_import_and_nothing_else():
    sources = dict(import_closure("tests.cases.fake_method").sources)
    assert "contact.answer.solution" in sources
    assert "cases.judgement.rules.norms" in sources  # what measures the answer is a part of it
    assert not any(name.startswith(("fem_reference", "reports")) for name in sources)
    assert {"numpy", "python"} <= set(dict(import_closure("tests.cases.fake_method").versions))


def test_a_lazy_package_counts_with_all_its_modules(tmp_path, monkeypatch):
    package = tmp_path / "lazy_package"
    package.mkdir()
    write_whole(package / "__init__.py", "def __getattr__(name):\n    return None\n")
    write_whole(package / "hidden.py", "import json\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert "lazy_package.hidden" in dict(import_closure("lazy_package").sources)


def test_a_changed_source_line_changes_the_hash(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    write_whole(tmp_path / "solver_one.py", "x = 1\n")
    write_whole(tmp_path / "solver_two.py", "x = 2\n")
    hashes = [dict(import_closure(name).sources)[name] for name in ("solver_one", "solver_two")]
    assert hashes[0] != hashes[1]


def test_reading_a_closure_imports_none_of_it(tmp_path, monkeypatch):
    package = tmp_path / "loud_package"
    package.mkdir()
    write_whole(package / "__init__.py", "raise RuntimeError\n")
    write_whole(package / "inner.py", "from loud_package.other import x\n")
    write_whole(package / "other.py", "x = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    own = {name for name, _ in import_closure("loud_package.inner").sources if name.startswith("loud_package")}
    assert own == {"loud_package", "loud_package.inner", "loud_package.other"}


def test_a_file_that_two_closures_share_is_read_once(tmp_path, monkeypatch):
    read, right = [], keys._imports
    monkeypatch.setattr(keys, "_imports", lambda tree, path, name: read.append(name) or right(tree, path, name))
    package = tmp_path / "sharing_package"
    package.mkdir()
    for name, text in {
        "__init__": "",
        "shared": "",
        "one": "from . import shared",
        "two": "from . import shared",
    }.items():
        write_whole(package / f"{name}.py", text)
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("one", "two"):
        assert "sharing_package.shared" in dict(import_closure(f"sharing_package.{name}").sources)
    assert read.count("sharing_package.shared") == 1
    assert len(set(read)) == len(read)
