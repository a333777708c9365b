"""A scene file with mistakes, on the command line: exit code 2, the words that help, no traceback, nothing written."""

import pytest

from tests.scene.test_bad_scenes import BAD


@pytest.mark.parametrize("name", BAD)
def test_a_bad_scene_file_is_refused_by_run(eventsim, tmp_path, name):
    text, problems = BAD[name]
    scene = tmp_path / "scene.toml"
    scene.write_text(text)
    result = eventsim("run", scene, "--until", "1", "--log", tmp_path / "log.csv", "--state", tmp_path / "end.csv")
    assert result.exit_code == 2
    assert "Traceback" not in result.output
    for words in problems:
        for word in words:
            assert word in result.output.replace("\n", " ")
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]
