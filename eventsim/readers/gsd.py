"""Frames of a .gsd file, by the gsd library: positions count from the middle of the box, in single precision.

Source of the format: https://gsd.readthedocs.io.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eventsim.errors import EventsimError
from eventsim.readers.samples import Samples, checked, last_digit, times_of_frames
from eventsim.reading import reading, told_as


def read_gsd(path: Path, dt: float | None = None, least: int = 2) -> Samples:
    """The samples of a file; dt: the time of a step of its clock, where frames log no time.

    Raises:
        EventsimError: naming the file, or the library that is missing.
    """
    try:
        import gsd.hoomd
    except ImportError:
        raise EventsimError("a .gsd file is read by the gsd library: pip install 'eventsim-disks[structure]'") from None
    what = "is not a whole gsd file"
    with reading(path, EventsimError, what):
        pass  # an ordinary file, which the library opens by its name
    with told_as(path, EventsimError, what), gsd.hoomd.open(name=str(path), mode="r") as file:
        frames = [file[k] for k in range(len(file))]
    counts = [int(frame.particles.N) for frame in frames]
    if not frames or len(set(counts)) > 1:
        raise EventsimError(f"{path}: must hold the same disks in each frame, not {sorted(set(counts))}")
    told = [float(np.ravel(frame.log["time"])[0]) if "time" in frame.log else None for frame in frames]
    if None in told and dt is not None:
        times = dt * np.array([float(frame.configuration.step) for frame in frames])
    else:
        times = times_of_frames(str(path), told, dt)
    boxes = np.array([frame.configuration.box[:2] for frame in frames], dtype=np.float64)
    if np.any(boxes != boxes[0]):
        raise EventsimError(f"{path}: the box changes its size: a scene has one domain")
    if any(np.any(frame.configuration.box[3:5] != 0.0) for frame in frames):
        raise EventsimError(f"{path}: the box is tilted: must have right angles")
    images = np.array([frame.particles.image[:, :2] for frame in frames], dtype=np.float64)
    places = np.array([frame.particles.position[:, :2] for frame in frames])
    speeds = np.array([frame.particles.velocity[:, :2] for frame in frames], dtype=np.float64)
    mass = np.array(frames[0].particles.mass, dtype=np.float64)
    return checked(
        Samples(
            str(path),
            times,
            places.astype(np.float64) + images * boxes[0],
            speeds if speeds.any() else None,  # the library gives zeros where a file has none
            0.5 * np.array(frames[0].particles.diameter, dtype=np.float64),
            np.where(mass > 0.0, mass, np.inf),  # what is immovable is written as 0
            (float(boxes[0, 0]), float(boxes[0, 1])),
            max(last_digit(places), float(np.finfo(np.float32).eps) * float(boxes.max())),
        ),
        least,
    )
