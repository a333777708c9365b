"""A motion written as other programs write it: plain, by nobody's code but the formats' own libraries."""

import csv

import numpy as np

FORMATS = ("csv", "wide.csv", "npz", "parquet", "xyz", "gsd")


def write(path, kind, times, places, speeds=None, box=(3.0, 3.0)):
    """Write positions, and velocities if there are any, in one of FORMATS; the path."""
    n = places.shape[1]
    if kind == "csv":
        with open(path, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["time", "disk", "x", "y", *(["vx", "vy"] if speeds is not None else [])])
            for k, time in enumerate(times):
                for i in range(n):
                    rows.writerow([time, i, *places[k, i], *(speeds[k, i] if speeds is not None else [])])
    elif kind == "wide.csv":
        head = ["t", *(f"{axis}{i}" for i in range(n) for axis in "xy")]
        table = np.column_stack([times, places.reshape(len(times), -1)])
        np.savetxt(path, table, delimiter=",", header=",".join(head), comments="")
    elif kind == "npz":
        np.savez(path, time=times, position=places, **({"velocity": speeds} if speeds is not None else {}))
    elif kind == "parquet":
        import pyarrow as pa
        import pyarrow.parquet as pq

        columns = {"time": np.repeat(times, n), "disk": np.tile(np.arange(n), len(times))}
        columns |= {"x": places[..., 0].ravel(), "y": places[..., 1].ravel()}
        if speeds is not None:
            columns |= {"vx": speeds[..., 0].ravel(), "vy": speeds[..., 1].ravel()}
        pq.write_table(pa.table(columns), path)
    elif kind == "xyz":
        with open(path, "w") as file:
            for k, time in enumerate(times):
                file.write(f"{n}\ntime = {float(time)!r}\n")
                file.writelines(f"Ar {x!r} {y!r} 0.0\n" for x, y in places[k].tolist())
    else:
        import gsd.hoomd

        with gsd.hoomd.open(name=str(path), mode="w") as file:
            for k, time in enumerate(times):
                frame = gsd.hoomd.Frame()
                frame.configuration.box, frame.configuration.step = [*box, 1.0, 0.0, 0.0, 0.0], k
                frame.particles.N = n
                frame.particles.position = np.column_stack([places[k] - 0.5 * np.array(box), np.zeros(n)])
                frame.log["time"] = np.array([time])
                file.append(frame)
    return path
