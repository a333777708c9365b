"""mp4: frames as raw pixels into an ffmpeg."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError

QUALITY = ("-preset", "veryfast", "-crf", "20", "-pix_fmt", "yuv420p")
"""x264's constant quality, near to lossless for flat colours; 4:2:0 because players know nothing else."""


def ffmpeg() -> str:
    """Return the ffmpeg to call: the one of the extra `video`, else one on the PATH; EventsimError where there is none."""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe  # an optional extra

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        found = shutil.which("ffmpeg")
    if found is None:
        raise EventsimError(
            "an mp4 needs ffmpeg, and there is none: pip install 'eventsim-disks[video]' (or write .gif, .html)"
        )
    return found


def write_mp4(part: Path, frames: Iterable[NDArray[np.uint8]], size: tuple[int, int], fps: float) -> None:
    """Encode frames (height, width, 4) into the file `part`; raise EventsimError where ffmpeg fails.

    An error or an interrupt ends ffmpeg; what it had written is left to the caller.
    """
    command = [
        ffmpeg(),
        "-y",
        "-loglevel",
        "error",
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgba",
        "-s",
        f"{size[0]}x{size[1]}",
    ]
    command += [
        "-r",
        repr(fps),
        "-i",
        "-",
        "-an",
        "-c:v",
        "libx264",
        *QUALITY,
        "-movflags",
        "+faststart",
        "-f",
        "mp4",
    ]
    with tempfile.TemporaryFile() as complaints:
        process = subprocess.Popen(
            [*command, str(part)],
            stdin=subprocess.PIPE,
            stdout=complaints,
            stderr=complaints,
            start_new_session=True,  # Ctrl-C is ours: ffmpeg is ended below
        )
        assert process.stdin is not None
        try:
            _feed(process.stdin, frames)
        except BaseException:
            process.kill()
            raise
        finally:
            process.wait()
        if process.returncode != 0:
            complaints.seek(0)
            last = complaints.read().decode(errors="replace").strip().splitlines()[-1:]
            raise EventsimError(f"ffmpeg could not write the movie: {' '.join(last) or f'code {process.returncode}'}")


def _feed(pipe: IO[bytes], frames: Iterable[NDArray[np.uint8]]) -> None:
    try:
        for frame in frames:
            pipe.write(frame.data)
        pipe.close()
    except BrokenPipeError:
        return  # ffmpeg gave up: its exit code and its last words tell why
