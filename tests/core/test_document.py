"""The history: steps, drags, merged edits."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sfumato import Document, Scene, SceneError


class Clock:
    """A clock that the test moves."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def exposure(document: Document) -> float:
    return document.scene.exposure


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def document(clock: Clock) -> Document:
    return Document(Scene(), clock)


def test_undo_and_redo(document: Document) -> None:
    first = document.scene
    document.change("Brighter", exposure=1.0)
    document.change("Brighter still", exposure=2.0)
    assert document.undo_label == "Brighter still"
    document.undo()
    assert (exposure(document), document.undo_label, document.redo_label) == (
        1.0,
        "Brighter",
        "Brighter still",
    )
    document.undo()
    assert document.scene is first
    document.undo()
    assert document.scene is first
    document.redo()
    document.redo()
    document.redo()
    assert exposure(document) == 2.0


def test_an_edit_empties_redo(document: Document) -> None:
    document.change("a", exposure=1.0)
    document.undo()
    document.change("b", exposure=3.0)
    document.redo()
    assert exposure(document) == 3.0
    assert document.redo_label == ""


def test_a_drag_is_one_step(document: Document) -> None:
    heard: list[float] = []
    document.subscribe(lambda old, new: heard.append(new.exposure))
    with document.drag("Exposure"):
        for k in range(1, 11):
            document.change("ignored", exposure=k / 10)
            assert document.dragging
    assert not document.dragging
    assert heard == [k / 10 for k in range(1, 11)]
    document.undo()
    assert exposure(document) == 0.0
    assert document.undo_label == ""


def test_a_drag_that_ends_where_it_began_is_no_step(document: Document) -> None:
    with document.drag("Exposure"):
        document.change("x", exposure=1.0)
        document.change("x", exposure=0.0)
    assert document.undo_label == ""


def test_undo_within_a_drag_takes_the_drag_back(document: Document) -> None:
    document.begin_drag("Exposure")
    document.change("x", exposure=1.0)
    document.undo()
    assert exposure(document) == 0.0
    assert not document.dragging


def test_edits_of_one_kind_within_a_second_are_one_step(document: Document, clock: Clock) -> None:
    for k in range(1, 6):
        clock.now += 0.5
        document.change("Turn", merge=True, exposure=float(k))
    clock.now += 1.5
    document.change("Turn", merge=True, exposure=9.0)
    document.undo()
    assert exposure(document) == 5.0
    document.undo()
    assert exposure(document) == 0.0


def test_other_labels_do_not_merge(document: Document) -> None:
    document.change("Turn", merge=True, exposure=1.0)
    document.change("Zoom", merge=True, exposure=2.0)
    document.undo()
    assert exposure(document) == 1.0


def test_nothing_changed_nothing_told(document: Document) -> None:
    heard: list[Scene] = []
    document.subscribe(lambda old, new: heard.append(new))
    document.change("Same", exposure=0.0)
    assert not heard
    assert document.undo_label == ""


def test_a_bad_change_leaves_all_as_it_was(document: Document) -> None:
    before = document.scene
    with pytest.raises(SceneError):
        document.change("Bad", **{"lights.0.tilt": 500})
    assert document.scene is before
    assert document.undo_label == ""


def test_listeners_can_leave_even_while_told(document: Document) -> None:
    heard: list[str] = []

    def once(old: Scene, new: Scene) -> None:
        heard.append("once")
        leave()

    leave = document.subscribe(once)
    document.subscribe(lambda old, new: heard.append("always"))
    document.change("a", exposure=1.0)
    document.change("b", exposure=2.0)
    leave()
    assert heard == ["once", "always", "always"]


def test_modified_since_saved(document: Document) -> None:
    assert not document.modified
    document.change("a", exposure=1.0)
    assert document.modified
    document.mark_saved()
    assert not document.modified
    document.undo()
    assert document.modified
    document.redo()
    assert not document.modified


def test_reset_starts_anew(document: Document) -> None:
    document.change("a", exposure=1.0)
    document.reset(Scene(exposure=4.0))
    assert (exposure(document), document.undo_label, document.modified) == (4.0, "", False)


@given(st.lists(st.sampled_from(["edit", "undo", "redo", "drag"]), max_size=30))
@settings(max_examples=40, deadline=None)
def test_undoing_everything_leads_back_and_redoing_forth(actions: list[str]) -> None:
    document = Document(Scene(), Clock())
    for k, action in enumerate(actions):
        if action == "edit":
            document.change("e", exposure=(k % 16) + 0.5)
        elif action == "drag":
            with document.drag("d"):
                document.change("e", exposure=(k % 16) + 0.25)
        else:
            getattr(document, action)()
    while document.redo_label:
        document.redo()
    last = document.scene
    while document.undo_label:
        document.undo()
    assert document.scene == Scene()
    while document.redo_label:
        document.redo()
    assert document.scene == last


def test_steps_name_every_state_and_any_can_be_gone_to(document: Document) -> None:
    for i, label in enumerate(("One", "Two", "Three")):
        document.change(label, exposure=i + 1.0)
    assert [(s.label, s.scene.exposure) for s in document.steps] == [
        ("", 0),
        ("One", 1),
        ("Two", 2),
        ("Three", 3),
    ]
    told: list[Scene] = []
    document.subscribe(lambda old, new: told.append(new))
    steps = document.steps
    for index in (0, 3, 1, 2):
        document.go_to(index)
        assert document.position == index
        assert document.scene is steps[index].scene
        assert document.steps == steps
        assert document.undo_label == steps[index].label
    assert len(told) == 4
    with pytest.raises(IndexError, match="no step 4"):
        document.go_to(4)
    document.change("Other", exposure=9.0)
    assert [s.label for s in document.steps] == ["", "One", "Two", "Other"]


def test_a_drag_is_no_step_before_its_end(document: Document) -> None:
    document.begin_drag("Dragged")
    document.change("Dragged", exposure=1.0)
    assert [s.scene.exposure for s in document.steps] == [0.0]
    document.end_drag()
    assert [s.label for s in document.steps] == ["", "Dragged"]
