"""Movies: what is in the file agrees with the log, and nothing is left where something went wrong."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

import eventsim as es
from eventsim.errors import EventsimError
from eventsim.replay.passage import Passage
from eventsim.replay.replay import Replay
from eventsim.show import strokes
from eventsim.show.animate import Film, animate
from eventsim.show.colouring import Colouring, colouring_of
from eventsim.show.frames import frames_at
from eventsim.show.overview import overview_of
from eventsim.show.picture import Look, Picture, _clock_format

imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="the extra video is not installed")
SMALL = Look(size=(320, 200))


def test_an_mp4_has_the_frames_size_and_duration_asked_for(broken, tmp_path):
    path = tmp_path / "break.mp4"
    animate(broken, path, Film(fps=25, duration=2.0), SMALL)
    reader = imageio_ffmpeg.read_frames(str(path))
    found = next(reader)
    reader.close()
    assert (found["size"], found["fps"], found["codec"]) == ((320, 200), 25.0, "h264")
    assert imageio_ffmpeg.count_frames_and_secs(str(path)) == (50, pytest.approx(2.0, abs=0.01))
    assert list(tmp_path.iterdir()) == [path]


def test_a_disk_in_the_movie_is_where_the_state_says(broken, tmp_path):
    path, look = tmp_path / "break.mp4", Look(size=(1280, 720), color="speed")
    animate(broken, path, Film(fps=25, duration=1.0, end=0.19), look)  # before the first contact only disk 0 is fast
    times = np.linspace(0.0, 0.19, 25)
    layout = Picture(Passage(broken), look, (1280, 720), times).layout
    frames = imageio_ffmpeg.read_frames(str(path))
    next(frames)
    for time, data in zip(times.tolist(), frames, strict=True):
        pixels = np.frombuffer(data, dtype=np.uint8).reshape(720, 1280, 3).astype(int)
        yellow = (pixels[..., 0] > 200) & (pixels[..., 1] > 180) & (pixels[..., 2] < 110)
        yellow[-60:] = False  # the key of the colours
        rows, columns = np.nonzero(yellow)
        found = columns.mean() + 0.5 - layout.scene[0], 720 - (rows.mean() + 0.5) - layout.scene[1]
        state = Replay(broken).state_at(time)
        expected = (state.position[0] - picture_corner(broken.scene)) * layout.scale
        assert np.abs(found - expected).max() < 0.5  # pixels


@pytest.mark.parametrize("name", ["broken", "fluid"])
def test_disks_are_drawn_where_the_state_says(name, request):
    log = request.getfixturevalue(name)
    replay = Replay(log)
    times = np.linspace(*replay.span, 3)
    picture = Picture(Passage(replay.log), Look(size=(1280, 720)), (1280, 720), times)
    unlike = np.random.default_rng(1).random((len(log.scene.disks), 4))  # no two disks of nearly the same colour
    unlike[:, 3] = 1.0
    picture._colouring = Colouring(lambda frame: unlike, None)
    left, bottom, _, _ = picture.layout.scene
    for frame in frames_at(Passage(replay.log), times, 1.0):
        pixels = picture.draw(frame).astype(int)
        centres = centres_in(picture, pixels, frame)
        x0, y0 = picture_corner(log.scene)
        expected = (frame.state.position - (x0, y0)) * picture.layout.scale + (left, bottom)
        low = np.array(log.scene.domain.origin) + log.scene.disks.radius.max()
        high = low + log.scene.domain.size - 2 * log.scene.disks.radius.max()
        inside = ((frame.state.position > low) & (frame.state.position < high)).all(axis=1)
        whole = np.isfinite(centres[:, 0]) & inside
        assert whole.sum() > 0.5 * len(whole)
        assert np.abs(centres - expected)[whole].max() < 0.2  # pixels


def picture_corner(scene):
    domain = scene.domain
    margin = 0.0 if domain.periodic[0] else 0.02 * max(domain.size)
    return domain.origin[0] - margin, domain.origin[1] - margin


def centres_in(picture, pixels, frame):
    """Centres of mass (N, 2), from the lower-left, of the pixels of each disk's colour; NaN where others share them."""
    colours = (picture._colouring.paint(frame)[:, :3] * 255).round().astype(int)
    height = pixels.shape[0]
    x0, y0 = picture_corner(picture._scene)
    left, bottom, _, _ = picture.layout.scene
    radius = picture._scene.disks.radius * picture.layout.scale
    centres = np.full((len(colours), 2), np.nan)
    for i, colour in enumerate(colours):
        x, y = (frame.state.position[i] - (x0, y0)) * picture.layout.scale + (left, bottom)
        reach = int(radius[i]) + 3
        column, row = int(x), int(height - y)
        if not (reach < column < pixels.shape[1] - reach and reach < row < height - reach):
            continue
        window = pixels[row - reach : row + reach + 1, column - reach : column + reach + 1, :3]
        rows, columns = np.nonzero(np.abs(window - colour).max(axis=2) <= 2)
        if abs(len(rows) / (np.pi * (radius[i] - 1.0) ** 2) - 1.0) < 0.15:  # a whole disk, and no other of this colour
            centres[i] = column - reach + columns.mean() + 0.5, height - (row - reach + rows.mean() + 0.5)
    return centres


def test_a_movie_shows_the_same_frame_whatever_came_before_it(fluid):
    replay = Replay(fluid)
    times = np.linspace(*replay.span, 5)
    drawn = [
        [picture.draw(frame).copy() for frame in frames_at(Passage(replay.log), shown, 0.01)]
        for shown in (times, times[[0, 4]])
        if (picture := Picture(Passage(replay.log), SMALL, (320, 200), times))
    ]
    assert np.array_equal(drawn[0][4], drawn[1][1])


def test_a_gif_lasts_as_long_as_asked_and_repeats(broken, tmp_path):
    path = tmp_path / "break.gif"
    animate(broken, path, Film(fps=30, duration=1.0), SMALL)
    with Image.open(path) as image:
        durations = [frame.info["duration"] for frame in ImageSequence.Iterator(image)]
        assert (image.size, sum(durations), image.info["loop"]) == ((320, 200), 1000, 0)


def test_a_gif_and_an_mp4_last_ten_seconds_where_nothing_is_asked(broken, tmp_path):
    for name in ("break.gif", "break.mp4"):
        animate(broken, tmp_path / name, Film(fps=2.0), SMALL)
    with Image.open(tmp_path / "break.gif") as image:
        assert sum(frame.info["duration"] for frame in ImageSequence.Iterator(image)) == 10_000
    assert imageio_ffmpeg.count_frames_and_secs(str(tmp_path / "break.mp4")) == (20, pytest.approx(10.0, abs=0.6))


def test_a_png_is_a_strip_of_moments(broken, tmp_path):
    path = tmp_path / "break.png"
    animate(
        broken,
        path,
        Film(moments=4),
        Look(size=(320, 200), trails=True, velocities=True, flash=True, dark=True),
    )
    with Image.open(path) as image:
        assert image.size == (640, 400)


@pytest.mark.parametrize("name", ["stadium", "channel", "brownian", "bounce", "sinai", "corridor", "mixture"])
@pytest.mark.parametrize("color", [None, "mass", "contacts"])
def test_every_kind_of_scene_can_be_drawn(name, color, tmp_path):
    log = es.simulate(es.gallery(name), events=40, log=True).log
    animate(log, tmp_path / "a.png", Film(moments=2), Look(color=color, trails=True, velocities=True))


@pytest.mark.parametrize("suffix", [".png", ".html"])
def test_a_compact_log_is_drawn_like_the_full_one(broken, tmp_path, suffix):
    broken.save(tmp_path / "compact.npz", compact=True)
    animate(es.load_log(tmp_path / "compact.npz"), tmp_path / f"a{suffix}")
    animate(broken, tmp_path / f"b{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_a_run_animates_itself(tmp_path):
    run = es.simulate(es.gallery("two-disks"), log=True)
    run.animate(tmp_path / "two.png", moments=2, dark=True)
    assert [path.name for path in tmp_path.iterdir()] == ["two.png"]
    with pytest.raises(EventsimError, match="no option colour"):
        run.animate(tmp_path / "two.png", colour="speed")
    with pytest.raises(EventsimError, match="log=True"):
        es.simulate(es.gallery("two-disks")).animate(tmp_path / "two.png")


@pytest.mark.parametrize("suffix", [".mp4", ".gif", ".png"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_an_interrupted_export_leaves_nothing(broken, tmp_path, suffix, error):
    def interrupt(fraction, events, time):
        if fraction > 0.4:
            raise error

    with pytest.raises(error):
        animate(broken, tmp_path / f"a{suffix}", Film(), SMALL, interrupt)
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_export_keeps_the_file_that_was_there(broken, tmp_path):
    path = tmp_path / "a.png"
    path.write_text("before")

    def interrupt(fraction, events, time):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(broken, path, Film(), SMALL, interrupt)
    assert path.read_text() == "before"


@pytest.mark.parametrize(
    ("name", "options", "expected"),
    [
        ("a.avi", {}, r"\.mp4, \.gif, \.html, \.png"),
        ("a.gif", {"size": (10, 10)}, "10x10"),
        ("a.gif", {"color": "mood"}, "mood"),
    ],
)
def test_what_cannot_be_drawn_is_one_sentence(broken, tmp_path, name, options, expected):
    with pytest.raises(EventsimError, match=expected):
        animate(broken, tmp_path / name, None, Look(**options))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".mp4", ".gif", ".png", ".html"])
def test_a_log_without_time_has_nothing_to_show(still, tmp_path, suffix):
    with pytest.raises(EventsimError, match="nothing to show"):
        animate(still, tmp_path / f"a{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_a_missing_ffmpeg_is_one_sentence(broken, tmp_path, monkeypatch):
    def missing():
        raise RuntimeError("no ffmpeg")

    monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", missing)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(EventsimError, match=r"eventsim-disks\[video\]"):
        animate(broken, tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []


def test_an_ffmpeg_that_fails_is_one_sentence(broken, tmp_path, monkeypatch):
    monkeypatch.setattr(sys.modules["eventsim.show.mp4"], "QUALITY", ("-pix_fmt", "nonsense"))
    with pytest.raises(EventsimError, match=r"ffmpeg could not write the movie: ."):
        animate(broken, tmp_path / "a.mp4", None, SMALL)
    assert list(tmp_path.iterdir()) == []


def test_drawing_needs_neither_a_display_nor_pyplot(tmp_path):
    code = (
        "import sys, eventsim as es; run = es.simulate(es.gallery('two-disks'), log=True); "
        "run.animate('a.png', moments=1); assert 'matplotlib.pyplot' not in sys.modules"
    )
    bare = {"HOME": str(tmp_path), "PYTHONPATH": str(Path(es.__file__).parents[1])}  # this package, installed or not
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=bare, check=True)


@pytest.mark.parametrize(
    ("times", "shown"),
    [
        ([0.0, 1.6, 3.2, 4.8], "4.8"),  # not 5, which would be elsewhere
        ([0.0, 1.0, 2.0], "2"),
        ([0.0, 5.0 / 3.0, 10.0 / 3.0], "3.33"),
        ([0.0, 1.0 / 30.0, 2.0 / 30.0], "0.067"),
        ([1e6, 1e6 + 1e-3], "1,000,000.001"),
        ([2.5, 2.5], "2.500"),
    ],
)
def test_the_clock_of_a_frame_is_not_rounded_to_another_place(times, shown):
    assert f"{times[-1]:{_clock_format(np.array(times))}}" == shown


def test_the_scale_of_speeds_reaches_the_fastest_disk_or_says_that_there_are_faster_ones():
    """A disk that falls and stays where it lands is fastest just before: no row tells it."""
    disk = es.Disks([[0.5, 2.1]], radius=0.1)
    scene = es.Scene(disk, es.Box((1.0, 3.0)), gravity=(0.0, -1.0), restitution=0.0)
    fallen = es.simulate(scene, until=3.0, log=True).log
    assert colouring_of("speed", scene.disks, overview_of(fallen)).key.beyond
    gas = es.simulate(es.gallery("gas", n=50), events=200, log=True).log
    key = colouring_of("speed", gas.scene.disks, overview_of(gas)).key
    assert key.beyond == (float(np.hypot(gas.vxa, gas.vya).max()) > key.high)


def test_one_event_is_counted_as_one_event():
    scene = es.Scene(es.Disks([[0.0, 0.0], [10.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5), es.Open())
    replay = Replay(es.simulate(scene, until=20.0, log=True).log)
    times = np.array([0.0, 20.0])
    picture = Picture(Passage(replay.log), SMALL, (320, 200), times)
    told = []
    for frame in frames_at(Passage(replay.log), times, 1.0):
        picture.draw(frame)
        told.append(picture._bars.counter.get_text().split("   ")[0])
    assert told == ["0 events", "1 event"]


@pytest.mark.parametrize(
    ("gravity", "size", "told"),
    [
        (None, (640, 480), "1 event   kinetic energy 0.5"),
        ((0.0, -1.0), (640, 480), "1 event   kinetic + potential energy 0.5 (0 at y = 0)"),
        ((0.0, -1.0), (320, 200), "1 event   kin. + pot. energy 0.5"),
    ],
)
def test_a_frame_says_which_energy_it_tells(gravity, size, told):
    disks = es.Disks([[0.0, 0.0], [10.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], 0.5)
    passage = Passage(es.simulate(es.Scene(disks, es.Open(), gravity=gravity), until=20.0, log=True).log)
    picture = Picture(passage, Look(size=size, color="species"), size, np.array([0.0, 20.0]))
    (frame,) = frames_at(passage, np.array([20.0]), 1.0)
    picture.draw(frame)
    assert picture._bars.counter.get_text() == told


@pytest.mark.parametrize(
    ("suffix", "film", "told"),
    [
        (".gif", Film(speed=0.3, end=0.03), "trails: last 0.3 time units   \N{MULTIPLICATION SIGN} 0.3   t = "),
        (".png", Film(moments=1), "trails: last 0.1 time units   t = "),
    ],
)
def test_a_movie_says_its_speed_and_how_far_trails_reach(broken, tmp_path, monkeypatch, suffix, film, told):
    clocks = []
    draw = Picture.draw

    def noting(self, frame):
        pixels = draw(self, frame)
        clocks.append(self._bars.clock.get_text())
        return pixels

    monkeypatch.setattr(Picture, "draw", noting)
    animate(broken, tmp_path / f"a{suffix}", film, Look(size=(320, 200), trails=True))
    assert clocks
    assert all(text.startswith(told) for text in clocks)


def test_a_bar_of_masses_tells_disks_that_have_no_place_on_it():
    disks = es.Disks([(1, 1), (2, 1), (3, 1)], radius=0.2, mass=[1, 3, np.inf])
    run = es.simulate(es.Scene(disks, es.Box((4, 2)), until=1.0), log=True)
    key = colouring_of("mass", disks, overview_of(run.log)).key
    assert (key.low, key.high) == (1.0, 3.0)
    assert [label for label, _ in key.apart] == ["mass inf"]


@pytest.mark.parametrize("suffix", [".gif", ".png"])
@pytest.mark.parametrize("begin", [None, 1.0])
def test_a_trail_is_the_parabola_behind_a_disk_and_has_nothing_of_later_times(tmp_path, monkeypatch, suffix, begin):
    """The frames from which a gif takes its colours left their trails in the film."""
    scene = es.Scene(es.Disks([[0.5, 2.5]], [[1.0, 0.0]], 0.1), es.Box((4.0, 3.0)), gravity=(0.0, -1.0))
    log = es.simulate(scene, until=2.0, log=True).log
    drawn, scales = [], []
    draw, follow = Picture.draw, strokes.Trails.follow

    def noting_scale(self, frame):
        scales.append(self.layout.scale)
        return draw(self, frame)

    def noting(self, frame):
        paths = list(follow(self, frame))
        drawn.append((frame.state.time, np.concatenate([np.empty((0, 2)), *(path.vertices for path, _ in paths)])))
        return iter(paths)

    monkeypatch.setattr(Picture, "draw", noting_scale)
    monkeypatch.setattr(strokes.Trails, "follow", noting)
    animate(log, tmp_path / f"a{suffix}", Film(fps=5, duration=2.0, begin=begin, moments=3), Look(trails=True))
    first = [place for place, (time, _) in enumerate(drawn) if time == (begin or 0.0)][-1] if suffix == ".gif" else 0
    assert not len(drawn[first][1])
    for time, points in drawn[first + 1 :]:
        assert len(points)
        assert points[:, 0].max() == pytest.approx(0.5 + time)
        middle = points.reshape(-1, 2, 2).mean(axis=1)
        missed = np.abs(middle[:, 1] - (2.5 - 0.5 * (middle[:, 0] - 0.5) ** 2))
        assert missed.max() * scales[0] < 0.3


def test_a_trail_of_more_ways_than_can_be_seen_reaches_back_less_far(broken, monkeypatch):
    """Those of a log of 1e7 rows took half a gigabyte."""

    def longest():
        passage = Passage(broken)
        trails = strokes.Trails(passage, 12, 200.0)
        frames = frames_at(passage, np.linspace(*passage.span, 40), 1.0)
        return max(sum(len(path.vertices) // 2 for path, _ in trails.follow(frame)) for frame in frames)

    assert longest() > 200
    monkeypatch.setattr(strokes, "MOST_RECENT", 150)
    assert 100 < longest() <= 150


def test_the_arrow_of_a_slow_ball_begins_at_its_rim_and_that_of_a_fast_one_stays_in_the_frame():
    disks = es.Disks(
        position=np.array([[0.5, 0.5], [0.899, 0.5]]), velocity=np.array([[0.02, 0.0], [1.0, 0.0]]), radius=0.1, mass=1.0
    )
    log = es.simulate(es.Scene(disks, es.Box((1.0, 1.0))), until=1e-3, log=True).log
    passage = Passage(log)
    (frame,) = frames_at(passage, np.array([5e-4]), 0.1)
    picture = Picture(passage, Look(velocities=True), (320, 240), np.array([5e-4]))
    tail, along = picture._from_rims(frame)
    assert tail[0] == pytest.approx(frame.state.position[0] + [0.1, 0.0])
    assert along[0][0] > 0.0
    low, high = picture._axes.get_xlim()
    assert high >= (tail + along)[:, 0].max()
    assert low < 0.0
