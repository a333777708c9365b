"""Structure of a fluid, averaged over exact states at even times: g(r), S(k), bond order psi_6, coordination.

Neighbours and pairs are found in double precision (`measure.neighbours`), and bond order of the neighbours is freud's.  g(r) has
bins of a hundredth of a diameter that begin at contact, and its value there is that of a polynomial through the first of them.
S(k) is |sum of exp(i k r)|^2 / N at wave vectors of the box.

Source: V. Ramasubramani et al., Comput. Phys. Commun. 254, 107275 (2020), doi:10.1016/j.cpc.2020.107275 (freud); J.-P. Hansen,
I. R. McDonald, Theory of Simple Liquids (2013), sections 2.5 and 4.1.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from eventsim.errors import EventsimError
from eventsim.measure import theory
from eventsim.measure.blocking import block_average
from eventsim.measure.ensemble import Ensemble, ensemble_of
from eventsim.measure.entries import Expected, averaged, beside, dash, unsteady_note
from eventsim.measure.found import Columns, Found
from eventsim.measure.measures import Measure
from eventsim.measure.neighbours import pairs_within, voronoi_neighbours, wrapped
from eventsim.record.events import Floats
from eventsim.replay.log import AnyLog
from eventsim.replay.passage import Passage
from eventsim.scene.stage import stage_of

Indices: TypeAlias = NDArray[np.int64]

FEWEST, MOST, WORK = 50, 200, 1_000_000
"""States that are looked at: as many as there are `WORK` disks in, within these bounds."""

SETTLING = 0.1
"""Share of a run that is left out where neither the scene nor anybody else says how much."""

LOOKERS = 2
"""States that are looked at at once: each takes memory."""

SHORT_BLOCK, TOGETHER = 48, 40
"""Disks whose waves are multiplied together, few enough for no library to begin threads of its own; and blocks made at once,
few enough for the nearest caches and enough for the other looker to go on meanwhile."""

BIN, FARTHEST = 0.01, 4.0
"""Width of a bin of g(r), and how far it goes, in diameters."""

FITTED, DEGREE = 20, 3
"""Bins from contact on through which a polynomial of this degree goes; what it leaves out is below .1 % at contact up to .6."""

NEAR = 1.5
"""Diameters up to which a disk counts as a neighbour: about the first minimum of g(r) of a dense fluid."""

LONG = 2.0
"""Wave number times diameter up to which S(k) is a + b k^2 + c k^4."""

SHORT, WAVES = 16.0, 32
"""Wave number times diameter up to which S(k) is told, and how many wave numbers along a side it is taken at."""

BANDS = 120
"""Bands of wave numbers that S(k) is told in."""


class _Sample(NamedTuple):
    """What one state says: pairs by bin, of each pair of species (pairs, bins); S at wave vectors (waves,); bond order of the
    whole and its mean size; neighbours of a disk; share of disks with six of them in Voronoi's sense."""

    pairs: Floats
    waves: Floats
    order: float
    local: float
    near: float
    sixfold: float


def found(log: AnyLog, discard: float | None) -> Found:
    """Return the structure along a run in a periodic domain, with bars; theory beside where it holds.

    Raises:
        EventsimError: where there is no freud.
    """
    freud = _freud()
    scene = log.scene
    ensemble = ensemble_of(scene, bool(log.provenance.kicks))
    why = _no_meaning(ensemble)
    if why is not None:
        return Found((dash("psi_6", "1", why),))
    passage = Passage(log)
    start, end = passage.span
    discard = scene.equilibration if discard is None else discard
    begun = min(start + (SETTLING * (end - start) if discard is None else discard), end)
    count = int(np.clip(WORK // max(ensemble.n, 1), FEWEST, MOST)) if end > begun else 1
    kept = np.flatnonzero(ensemble.counted)
    looker = _Looker(freud, ensemble, kept)
    # in the middles of even spans: where a run ends with an event, two disks touch
    times = begun + (np.arange(count) + 0.5) * ((end - begun) / count)
    with freud.parallel.NumThreads(1):
        samples = list(_looked_at(looker, (state.position[kept] for state in passage.states(times.tolist()))))
    note = unsteady_note(ensemble)
    contacts, g = looker.distribution(np.array([sample.pairs for sample in samples]), note)
    waves, s = looker.structure_factor(np.array([sample.waves for sample in samples]), note)
    order = np.array([sample.order for sample in samples])
    spread = ensemble.n * (order * order - 2.0 * order.mean() * order + order.mean() ** 2)
    quantities = (
        _entry("psi_6", order, note),
        _entry("psi_6_susceptibility", spread, note),
        _entry("psi_6_local", np.array([sample.local for sample in samples]), note),
        _entry("coordination", np.array([sample.near for sample in samples]), note),
        _entry("sixfold", np.array([sample.sixfold for sample in samples]), note),
    )
    told = f"{len(samples)} states from t = {begun:.6g} to {end:.6g}; coordination: disks nearer than {NEAR:g} diameters"
    return Found((*contacts, *waves, *quantities), {"g": g, "S": s}, (told,))


def _looked_at(looker: _Looker, places: Iterable[Floats]) -> Iterator[_Sample]:
    """Yield what states say, in order; some are looked at while the log is read on."""
    with ThreadPoolExecutor(LOOKERS) as pool:
        waiting: deque[Future[_Sample]] = deque()
        for place in places:
            waiting.append(pool.submit(looker.look, place))
            if len(waiting) > LOOKERS:
                yield waiting.popleft().result()
        for looked in waiting:
            yield looked.result()


def _freud() -> Any:
    try:
        import freud
    except ImportError:
        raise EventsimError("structure is measured by freud: pip install 'eventsim-disks[structure]'") from None
    return freud


def _no_meaning(ensemble: Ensemble) -> str | None:
    """Why a scene has no such structure, a clause."""
    if not ensemble.torus:
        return f'the domain is "{ensemble.scene.domain.kind}": structure is measured in periodic ones'
    if ensemble.n < 4:
        return "fewer than 4 disks have no structure"
    if math.isnan(ensemble.species[0].radius):
        return "there are more kinds of disks than can be told apart"
    return None if ensemble.scene.disks.radius[ensemble.counted].any() else "points have no structure"


def _entry(name: str, series: Floats, note: str | None, expected: Expected | None = None) -> Measure:
    """A mean over states with its bar."""
    bar = block_average(series)
    entry = averaged(name, bar, "1", note)
    return beside(entry if note is None else replace(entry, error=math.nan), expected)


def _waves(phase: Floats, steps: Indices) -> Floats:
    """Cosines and sines in turn (blocks, SHORT_BLOCK, 2 steps) of multiples of the phases of disks; 0 behind the last one.

    Where a step follows the one before, its wave is the product of that one with the first.
    """
    waves = np.zeros((-(-len(phase) // SHORT_BLOCK) * SHORT_BLOCK, len(steps), 2))
    powers = waves[: len(phase)].view(np.complex128)[:, :, 0]
    one = np.exp(1j * phase)
    for place, step in enumerate(steps.tolist()):
        if place and step == steps[place - 1] + 1:
            np.multiply(powers[:, place - 1], one, out=powers[:, place])
        else:
            np.exp(1j * (phase * step), out=powers[:, place])
    return waves.reshape(-1, SHORT_BLOCK, 2 * len(steps))


class _Looker:
    """Looks at states of the disks of an ensemble that carry energy."""

    def __init__(self, freud: Any, ensemble: Ensemble, kept: Indices) -> None:
        """freud: the library.  kept: the disks that are looked at."""
        self._freud, self._ensemble, self._stage = freud, ensemble, stage_of(ensemble.scene)
        domain = ensemble.scene.domain
        assert domain.size is not None
        self._size, self._origin = np.array(domain.size), np.array(domain.origin)
        self._box = freud.box.Box(Lx=self._size[0], Ly=self._size[1], is2D=True)
        self._kind = ensemble.species_of[kept]
        kinds = range(ensemble.kinds)
        self._pairs = [(i, j) for i in kinds for j in kinds if i <= j]
        self._place = np.zeros((ensemble.kinds, ensemble.kinds), np.int64)
        for place, (i, j) in enumerate(self._pairs):
            self._place[i, j] = self._place[j, i] = place
        self._reach = np.array([ensemble.species[i].radius + ensemble.species[j].radius for i, j in self._pairs])
        self._bins = int((FARTHEST - 1.0) / BIN)
        self._far = min(FARTHEST * float(self._reach.max()), 0.499 * float(self._size.min()))
        self._waves()

    def _waves(self) -> None:
        """Choose wave vectors: all of the longest waves, then ever fewer; one of each pair k, -k."""
        diameter = self._ensemble.diameter
        steps = []
        for length in self._size.tolist():
            most = max(int(SHORT * length / (2.0 * math.pi * diameter)), 1)
            dense = min(most, WAVES // 2)
            further = np.geomspace(dense + 1, most, WAVES - dense) if most > dense else np.empty(0)
            steps.append(np.unique(np.concatenate([np.arange(dense + 1), np.rint(further)])).astype(np.int64))
        self._along_x, y = steps
        self._along_y = np.concatenate([-y[:0:-1], y])
        kx = 2.0 * math.pi / self._size[0] * self._along_x[:, None]
        ky = 2.0 * math.pi / self._size[1] * self._along_y
        k = np.hypot(kx, ky)
        told = (k * diameter <= SHORT) & ((self._along_x[:, None] > 0) | (self._along_y > 0))
        self._chosen = np.flatnonzero(told)
        self._k = k.ravel()[self._chosen]

    def look(self, place: Floats) -> _Sample:
        """Look at a state, (n, 2)."""
        place = wrapped(place - self._origin, self._size)
        one, other, apart = voronoi_neighbours(place, self._size)
        bonds = self._bond_order(place, one, other, apart)
        pairs, near = self._pairs_by_bin(place)
        return _Sample(
            pairs=pairs,
            waves=self._structure_factor(place),
            order=float(np.abs(bonds.mean())),
            local=float(np.abs(bonds).mean()),
            near=near,
            sixfold=float((np.bincount(one, minlength=len(place)) == 6).mean()),
        )

    def _bond_order(self, place: Floats, one: Indices, other: Indices, apart: Floats) -> NDArray[np.complex64]:
        """psi_6 of each disk, of its neighbours."""
        order = np.argsort(one, kind="stable")
        flat = np.zeros((len(order), 3))
        flat[:, :2] = apart[order]
        bonds = self._freud.locality.NeighborList.from_arrays(len(place), len(place), one[order], other[order], flat)
        hexatic = self._freud.order.Hexatic(k=6, weighted=False)
        points = np.column_stack([place - 0.5 * self._size, np.zeros(len(place))])
        hexatic.compute((self._box, points), neighbors=bonds)
        return np.asarray(hexatic.particle_order)

    def _pairs_by_bin(self, place: Floats) -> tuple[Floats, float]:
        """Pairs of each pair of species by bin (pairs, bins), and neighbours of a disk."""
        one, other = pairs_within(place, self._size, self._far).T
        apart = self._stage.nearest(place[one] - place[other])
        distance = np.hypot(apart[:, 0], apart[:, 1])
        which = self._place[self._kind[one], self._kind[other]]
        away = distance / self._reach[which]
        counted = np.maximum(((away - 1.0) / BIN).astype(np.int64), 0)
        told = counted < self._bins
        flat = np.bincount(which[told] * self._bins + counted[told], minlength=len(self._pairs) * self._bins)
        near = 2.0 * float((away < NEAR).sum()) / len(place)
        return flat.reshape(len(self._pairs), self._bins).astype(np.float64), near

    def _structure_factor(self, place: Floats) -> Floats:
        """|sum of exp(i k r)|^2 / N at the chosen wave vectors: the waves along x times those along y, as one product."""
        up = self._along_y[self._along_y >= 0]
        products = np.zeros((2 * len(self._along_x), 2 * len(up)))
        for first in range(0, len(place), SHORT_BLOCK * TOGETHER):
            phase = 2.0 * math.pi / self._size * place[first : first + SHORT_BLOCK * TOGETHER]
            waves_x, waves_y = _waves(phase[:, 0], self._along_x), _waves(phase[:, 1], up)
            products += (waves_x.transpose(0, 2, 1) @ waves_y).sum(axis=0)
        (cc, cs), (sc, ss) = products.reshape(len(self._along_x), 2, len(up), 2).transpose(1, 3, 0, 2)
        falling, rising = (cc + ss) ** 2 + (sc - cs) ** 2, (cc - ss) ** 2 + (sc + cs) ** 2  # k_y below 0, and from 0 on
        factor: Floats = np.hstack([falling[:, :0:-1], rising]).ravel()[self._chosen] / len(place)
        return factor

    def distribution(self, pairs: Floats, note: str | None) -> tuple[list[Measure], Columns]:
        """G(r) of each pair of species from counts (states, pairs, bins): its contact value and its columns."""
        edges = 1.0 + BIN * np.arange(self._bins + 1)
        area = math.pi * np.diff(edges * edges)
        middle = 0.5 * (edges[1:] + edges[:-1])
        powers = np.vander(middle[:FITTED] - 1.0, DEGREE + 1, increasing=True)
        at_contact = np.linalg.pinv(powers)[0]
        counts = [self._ensemble.species[k].number for k in range(self._ensemble.kinds)]
        entries: list[Measure] = []
        columns: Columns = {}
        for place, (i, j) in enumerate(self._pairs):
            end = f"_{self._ensemble.called[i]}_{self._ensemble.called[j]}" if len(counts) > 1 else ""
            ideal = (0.5 * counts[i] * (counts[i] - 1) if i == j else counts[i] * counts[j]) / float(self._size.prod())
            known = int(np.sum(edges[1:] * self._reach[place] <= self._far))
            if ideal == 0.0 or known < FITTED:
                entries.append(dash(f"g_contact{end}", "1", "there are too few disks, or the box is too small"))
                continue
            g = pairs[:, place] / (ideal * area * self._reach[place] ** 2)
            entries.append(_entry(f"g_contact{end}", g[:, :FITTED] @ at_contact, note, self._contact_value(i, j)))
            columns[f"r{end}"] = (middle[:known] * self._reach[place]).tolist()
            columns[f"g{end}"] = g[:, :known].mean(axis=0).tolist()
            columns[f"g{end}_error"] = [block_average(column).error for column in g[:, :known].T]
        return entries, columns

    def _contact_value(self, i: int, j: int) -> Expected | None:
        """What theory expects at contact."""
        ensemble, eta = self._ensemble, self._ensemble.packing_fraction
        if not ensemble.simple or eta is None:
            return None
        if ensemble.equal and eta <= theory.KOLAFA_ROTTNER_UP_TO:
            z = theory.compressibility_factor(eta)
            value = theory.contact_value(eta, z)
            return Expected(value, theory.KOLAFA_ROTTNER_ACCURACY * value, "(Z - 1) / 2 eta, Kolafa & Rottner 2006")
        if not ensemble.equal and eta <= theory.MIXTURE_UP_TO:
            area = float(self._size.prod())
            mixture = [
                theory.Component(kind.number / area, 2.0 * kind.radius, kind.mass) for kind in ensemble.species[: ensemble.kinds]
            ]
            value = theory.mixture_contact_value(mixture, i, j)
            return Expected(value, theory.MIXTURE_ACCURACY * value, "Jenkins & Mancini 1987")
        return None

    def structure_factor(self, waves: Floats, note: str | None) -> tuple[list[Measure], Columns]:
        """S(0) and the columns of S(k), from S (states, waves) at the chosen wave vectors."""
        diameter = self._ensemble.diameter
        long = self._k * diameter <= LONG
        if len(np.unique(self._k[long].round(9))) > 4:
            powers = np.vander((self._k[long] * diameter) ** 2, 3, increasing=True)
            entry = _entry("S_0", waves[:, long] @ np.linalg.pinv(powers)[0], note, self._compressibility())
        else:
            entry = dash("S_0", "1", "the box is too small for long waves")
        edges = np.linspace(0.0, SHORT / diameter, BANDS + 1)
        band = np.clip(np.searchsorted(edges, self._k, side="right") - 1, 0, BANDS - 1)
        columns: Columns = {"k": [], "S": [], "S_error": []}
        for number in np.unique(band).tolist():
            those = band == number
            bar = block_average(waves[:, those].mean(axis=1))
            columns["k"].append(float(self._k[those].mean()))
            columns["S"].append(bar.mean)
            columns["S_error"].append(bar.error)
        return [entry], columns

    def _compressibility(self) -> Expected | None:
        """rho kT times the compressibility, which is S(0): 1 / (d eta Z / d eta)."""
        eta = self._ensemble.packing_fraction
        if not (self._ensemble.simple and self._ensemble.equal) or eta is None or eta > theory.KOLAFA_ROTTNER_UP_TO:
            return None
        z, slope, _ = theory.fluid(eta)
        value = 1.0 / (z + eta * slope)
        return Expected(value, theory.KOLAFA_ROTTNER_ACCURACY * value, "1 / (Z + eta Z'), Kolafa & Rottner 2006")
