"""YAML from outside: bounded in size, depth and effort, and whatever is wrong is one sentence."""

import os

import pytest
from trackvib_sim.yaml_text import LARGEST, YamlTextError, load, read_text

pytestmark = pytest.mark.property


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("&a [*a]", "alias *a is not accepted"),
        ("a: &x [1]\nb: *x", "alias *x is not accepted"),
        ("a: 1\nb: {a: 2}\na: 1", "a is given twice, in lines 1 and 3"),
        ("{a: 1, a: 2}", "a is given twice, in lines 1 and 1"),
        ("[" * 3000, "nested too deeply, accepted: 50 levels"),
        ("{a: " * 3000, "nested too deeply"),
        ("- " * 3000, "nested too deeply"),
        ("a: 2001-99-99", "not a YAML file"),
        ("a: !!int ''", "not a YAML file"),
        ("a: !!bool q", "a value has the wrong type: 'q'"),
        ("? [1]\n: 2", "not a YAML file"),
        ("a: " + ":".join(["1"] * 100_000), "a number of 199999 characters, accepted: 100"),
        ("!!python/object/apply:os.system [id]", "not a YAML file"),
        ("!<" + "x" * 100_000 + "> a", "not a YAML file"),
        ("# " + "x" * LARGEST, f"accepted: {LARGEST}"),
        ("a: \x1b[31m", "not a YAML file"),
    ],
)
def test_texts_are_refused_in_one_line(text, words):
    """It names the file and says why, in few printable signs."""
    with pytest.raises(YamlTextError) as refused:
        load(text, "a\x1b.yaml")
    message = str(refused.value)
    assert words in message and message.startswith("a\\x1b.yaml") and message.isprintable() and len(message) < 1000


def test_what_is_no_ordinary_file_is_refused(tmp_path):
    """A pipe that nobody writes to, a device, a folder, a loop of links, one that is too large: at once."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "large").write_bytes(bytes(LARGEST + 1))
    for path in (tmp_path / "pipe", "/dev/zero", tmp_path, tmp_path / "loop", tmp_path / "large", "a\0b"):
        with pytest.raises(YamlTextError, match="cannot be read: "):
            read_text(path)


def test_a_link_to_a_file_is_read(tmp_path):
    """As every tool does."""
    (tmp_path / "file").write_text("a: 1\n")
    (tmp_path / "link").symlink_to("file")
    assert load(read_text(tmp_path / "link"), "link") == {"a": 1}
