"""Equal keys mean equal scene, settings, code and versions: only then an answer is used again."""

import dataclasses

from cases.declare.methods import MethodUse, TableEntry
from cases.run import keys
from cases.run.keys import code, question
from contact.files.whole import write_whole
from tests.cases.fake_case import fake_case


def task(case=None):
    return next((case or fake_case()).tasks())


def test_the_last_bit_of_a_scene_is_the_same_question_but_another_answer():
    old = task()
    layer = old.problem.layer
    scene = old.problem.replace(layer=layer.replace(poissons_ratio=0.3 + 2e-16))
    new = dataclasses.replace(old, problem=scene)
    assert layer.poissons_ratio != scene.layer.poissons_ratio
    assert question(old) == question(new)
    assert code(old) != code(new)


def test_a_changed_line_of_a_methods_package_changes_the_code(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    package = tmp_path / "solver_package"
    package.mkdir()
    (package / "__init__.py").touch()
    write_whole(package / "hidden.py", "x = 1\n")
    entry = TableEntry(module="solver_package", attribute="Solver")
    monkeypatch.setitem(keys.location.__globals__["BUILT_IN"], "other", entry)
    one = dataclasses.replace(task(), use=MethodUse(label="other"))
    before = code(one)
    keys._sources.cache_clear()
    assert code(one) == before
    write_whole(package / "hidden.py", "x = 2\n")
    keys._sources.cache_clear()
    assert code(one) != before
    keys._sources.cache_clear()
