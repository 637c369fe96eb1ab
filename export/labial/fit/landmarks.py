"""Finds the points of a head's lips in an avatar's mesh, from the motion of its shapes.

The names of shapes serve only to find the shape that opens the mouth. The seam of the lips is where this shape
separates neighbouring vertices. Its middle, in front and on the midline, are the inner lips; its ends are the corners.
The outer lips, the nose's base and the chin are features of the profile on the midline.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Optional, Tuple

import numpy as np

from labial.errors import DataError
from labial.files import limits
from labial.fit.avatar import Mesh
from labial.fit.head import NEEDED, POINTS, USUAL_MNS, Head, from_points, plain

#: Shapes that open the mouth, the plainest first; compared without case, prefixes and punctuation.
_OPENERS = ("jawopen", "visemeaa", "fclmtha", "aa", "mouthopen", "openmouth", "a", "open")
#: How far an upper and a lower vertex go apart for each unit of their distance where a seam runs between them; times
#: the mouth's whole opening divided by the face's width. In the lips' middle, and towards the corners.
_TORN_MIDDLE, _TORN = 4.0, 15.0
#: Slope of the profile with which the nose begins, as at the landmark of its base in 16 of ICT-FaceKit's heads.
_NOSE = 0.5
#: Millimetres between the inner lips at rest from which on a mouth counts as open.
_APART = 1.0
#: Least extent of a mesh, in the file's unit.
_SMALLEST = 1e-6
#: Most pairs of vertices among which the lips' middle is looked for, edges of a profile, and neighbours of the vertices
#: on the seam: a real face has a hundredth of each.
_PAIRS, _EDGES, _BRANCHES = 4_000_000, 200_000, 2_000


class Found(NamedTuple):
    """The points of an avatar."""

    head: Head
    vertices: Dict[str, int]  #: number of each point's vertex
    scale: float  #: millimetres per unit of the file
    doubts: List[str]  #: warnings
    mesh: Mesh


def opener(mesh: Mesh) -> Optional[str]:
    """The shape that opens the mouth."""
    names = {plain(name): name for name in reversed(list(mesh.shapes))}
    for wanted in _OPENERS:
        for name, full in names.items():
            called = name == wanted or (len(wanted) > 2 and name.endswith(wanted))
            if called and np.abs(mesh.shapes[full]).max() > 0.0:
                return full
    return None


def choose(meshes: List[Mesh], where: str) -> Mesh:
    """The face among the meshes: of teeth, eyes and beards with the same shapes it has the most moving vertices above
    what moves down most. Raises DataError where no shape opens a mouth."""

    def score(mesh: Mesh) -> float:
        name = opener(mesh)
        if name is None:
            return -1.0
        size = np.linalg.norm(mesh.shapes[name], axis=1)
        return float((size > 0.02 * size.max()).sum() * np.ptp(mesh.vertices[:, 1]))

    best = max(meshes, key=score)
    if score(best) < 0.0:
        names = list(meshes[0].shapes)
        more = ", ".join(names[:12]) + (" ..." if len(names) > 12 else "")
        raise DataError(where, None, "no shape opens the mouth: jawOpen, mouthOpen, viseme_aa, Fcl_MTH_A or aa is "
                        f"needed; there are {more}. Rename the one that does")
    return best


def scale_of(mouth_nose: float) -> Tuple[float, str]:
    """Millimetres per unit for a head whose nose and mouth are so many units apart, and what the unit is."""
    for unit, factor in (("metres", 1000.0), ("centimetres", 10.0), ("millimetres", 1.0)):
        if 0.5 <= mouth_nose * factor / USUAL_MNS <= 2.0:
            return factor, unit
    return USUAL_MNS / mouth_nose, "of unknown size"


class _Face:
    """A mesh with its seams welded, in the file's unit."""

    def __init__(self, mesh: Mesh, where: str) -> None:
        name = opener(mesh)
        assert name is not None
        size = float(np.ptp(mesh.vertices, axis=0).max()) if len(mesh.vertices) else 0.0
        if not size >= _SMALLEST:
            raise DataError(where, None, f"the mesh {mesh.name[:60]!r} is {size:g} wide, not a face")
        grid = np.round((mesh.vertices - mesh.vertices.min(axis=0)) / (1e-5 * size)).astype(np.int64)
        _, first, inverse = np.unique(grid @ [1 << 40, 1 << 20, 1], return_index=True, return_inverse=True)
        self.where = where
        self.first, self.points = first, mesh.vertices[first]
        self.down = -mesh.shapes[name][first][:, 1].astype(np.float64)
        self.jaw = float(self.down.max())
        if not self.jaw > 0.0:
            raise DataError(where, None, f"the shape {name!r} moves nothing down, towards -y: in glTF y is up")
        moving = np.linalg.norm(mesh.shapes[name][first], axis=1) > 0.02 * self.jaw
        self.size = float(np.ptp(self.points[moving][:, 0]))
        if not self.size > 0.0:
            raise DataError(where, None, f"the shape {name!r} moves nothing that is wide")
        self.middle = float((self.points[moving][:, 0].min() + self.points[moving][:, 0].max()) / 2.0)
        edges = np.concatenate([inverse[mesh.triangles[:, pair]] for pair in ((0, 1), (1, 2), (2, 0))])
        pairs = np.unique(np.sort(edges, axis=1) @ [1 << 32, 1])
        edges = np.stack([pairs >> 32, pairs & 0xffffffff], axis=1)
        self.edges = edges[edges[:, 0] != edges[:, 1]]
        both = np.concatenate([self.edges, self.edges[:, ::-1]])
        order = np.argsort(both[:, 0], kind="stable")
        self.neighbours = both[order, 1]
        self.starts = np.searchsorted(both[order, 0], np.arange(len(self.points) + 1))

    def beside(self, vertex: int) -> np.ndarray:
        return self.neighbours[self.starts[vertex] : self.starts[vertex + 1]]

    def strip(self, width: float) -> np.ndarray:
        """Which vertices lie on the midline, within a share of the face's size."""
        return np.abs(self.points[:, 0] - self.middle) < width * self.size

    def profile(self, keep: np.ndarray, begin: float, end: float, count: int) -> Tuple[np.ndarray, np.ndarray,
                                                                                       np.ndarray]:
        """Along the midline from height `begin` to `end`: height, how far in front the foremost place lies, and its
        nearest vertex. Places along edges count, so that coarse meshes have a profile, too."""
        edges = self.edges[(keep & self.strip(0.03))[self.edges].all(axis=1)]
        limits.refuse(self.where, "on its midline the face has", len(edges), _EDGES, "edges")
        share = np.linspace(0.0, 1.0, 9)
        ends = self.points[edges]
        places = (ends[:, 0, None] * (1.0 - share)[None, :, None] + ends[:, 1, None] * share[None, :, None]).reshape(
            -1, 3)
        nearest = np.where(share[None] < 0.5, edges[:, :1], edges[:, 1:]).ravel()
        heights = np.linspace(begin, end, count)
        step = abs(end - begin) / (count - 1)
        found = []
        for height in heights:
            close = np.flatnonzero(np.abs(places[:, 1] - height) <= 0.75 * step)
            if len(close):
                best = close[np.argmax(places[close, 2])]
                found.append((height, places[best, 2], nearest[best]))
        y, z, vertex = np.array(found, float).reshape(-1, 3).T
        return y, z, vertex.astype(int)


def _inner(face: _Face) -> Tuple[int, int]:
    """The middles of the inner lips: the foremost pair on the midline of an upper vertex that stays and a lower one,
    near it, that goes."""
    for width in (0.012, 0.03, 0.06):
        middle = face.strip(width)
        upper = np.flatnonzero(middle & (face.down < 0.3 * face.jaw))
        lower = np.flatnonzero(middle & (face.down > 0.55 * face.jaw))
        if not len(upper) or not len(lower):
            continue
        limits.refuse(face.where, "on its midline the mouth has", len(upper) * len(lower), _PAIRS, "pairs of vertices")
        apart = np.linalg.norm(face.points[upper][:, None] - face.points[lower][None], axis=2)
        torn = (face.down[lower][None] - face.down[upper][:, None]) / (apart + 0.002 * face.size)
        near = np.argwhere((torn > _TORN_MIDDLE * face.jaw / face.size) & (apart <= max(2.2 * float(apart.min()),
                                                                                 0.012 * face.size)))
        if len(near):
            front = face.points[upper][near[:, 0], 2] + face.points[lower][near[:, 1], 2]
            best = near[np.argmax(front - 1.5 * apart[near[:, 0], near[:, 1]])]
            return int(upper[best[0]]), int(lower[best[1]])
    raise DataError(face.where, None, f"the seam of the lips was not found: name {', '.join(NEEDED)} with --point")


def _seam(face: _Face, upper: int, lower: int, sign: float) -> List[Tuple[int, int]]:
    """Pairs of an upper and a lower vertex from the middle to a corner, as far as the lips part."""
    pairs = [(upper, lower)]
    seen = {upper}
    branches = 0
    for _ in range(100):
        here = pairs[-1][0]
        branches += len(face.beside(here))
        limits.refuse(face.where, "beside the seam of its lips the face has", branches, _BRANCHES, "vertices")
        steps: List[Tuple[float, int, int]] = []
        for step in face.beside(here):
            move = face.points[step] - face.points[here]
            if int(step) in seen or sign * move[0] <= 0.1 * abs(move[1]):
                continue
            apart = np.linalg.norm(face.points - face.points[step], axis=1)
            torn = (face.down - face.down[step]) / (apart + 0.002 * face.size)
            fits = (torn > _TORN * face.jaw / face.size) & (apart < 0.035 * face.size)
            if fits.any():
                partner = int(np.argmin(np.where(fits, apart, np.inf)))
                steps.append((float(apart[partner]), int(step), partner))
        if not steps:
            break
        pairs.append(min(steps, key=lambda found: found[0])[1:])
        seen.add(pairs[-1][0])
    return pairs


def _outer_corner(face: _Face, inner: int, sign: float) -> int:
    """The corner as it is seen from the front: the outermost vertex just beyond the seam's end."""
    off = face.points - face.points[inner]
    near = np.flatnonzero((np.linalg.norm(off, axis=1) < 0.03 * face.size) & (sign * off[:, 0] < 0.022 * face.size)
                          & (off[:, 2] > -0.005 * face.size))
    if not len(near):
        return inner
    return int(near[np.argmax(sign * off[near, 0] - 0.5 * np.abs(off[near, 1]))])


def _first_peak(z: np.ndarray) -> int:
    """The first place in front of both sides of it; -1 without places."""
    peaks = (place for place in range(1, len(z) - 1)
             if z[place] >= z[place - 1] and z[place] > z[place + 1 : place + 3].max())
    return next(peaks, int(np.argmax(z)) if len(z) else -1)


def find(mesh: Mesh, where: str) -> Dict[str, int]:
    """Vertices of the points that it finds. Raises DataError where the lips are not found."""
    face = _Face(mesh, where)
    found: Dict[str, int] = {}
    found["inner_upper"], found["inner_lower"] = _inner(face)
    middle = face.points[found["inner_upper"]]
    half = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pairs = _seam(face, found["inner_upper"], found["inner_lower"], sign)
        found[f"corner_{side}"] = _outer_corner(face, pairs[-1][0], sign)
        across = np.abs(face.points[[pair[0] for pair in pairs]][:, 0] - middle[0])
        place = int(np.argmin(np.abs(across - 0.45 * across.max())))
        if 0 < place < len(pairs) - 1:
            found[f"inner_upper_{side}"], found[f"inner_lower_{side}"] = pairs[place]
        half.append(abs(face.points[found[f"corner_{side}"]][0] - middle[0]))
    high = 0.35 * float(np.mean(half))  # lips are about a third as thick as the mouth is wide to either side
    for lip, sign, keep in (("upper", 1.0, face.down < 0.5 * face.jaw), ("lower", -1.0, face.down > 0.3 * face.jaw)):
        start = face.points[found[f"inner_{lip}"]][1]
        _, z, vertices = face.profile(keep, start, start + sign * 2.0 * high, 24)
        peak = _first_peak(z)
        if peak < 0:
            continue
        found[f"outer_{lip}"] = int(vertices[peak])
        thick = abs(face.points[vertices[peak]][1] - start)
        for side in ("left", "right"):
            corner = face.points[found[f"corner_{side}"]]
            x = middle[0] + 0.5 * (corner[0] - middle[0])
            off = sign * (face.points[:, 1] - corner[1])
            column = np.flatnonzero((np.abs(face.points[:, 0] - x) < 0.03 * face.size) & keep
                                    & (off > -0.2 * thick) & (off < 1.2 * thick))
            if len(column):
                found[f"outer_{lip}_{side}"] = int(column[np.argmax(face.points[column, 2])])
    _nose_and_chin(face, found)
    return {name: int(face.first[vertex]) for name, vertex in found.items()}


def _nose_and_chin(face: _Face, found: Dict[str, int]) -> None:
    """The nose's base, where the profile above the upper lip turns forward; the chin, below the hollow under the lower
    lip the last place that is as far in front as its middle."""
    wide = face.points[found["corner_left"]][0] - face.points[found["corner_right"]][0]
    lip = face.points[found.get("outer_upper", found["inner_upper"])]
    y, z, vertices = face.profile(np.full(len(face.points), True), lip[1], lip[1] + 0.9 * wide, 60)
    if len(z) > 8:
        out = np.flatnonzero(z > lip[2] + 0.06 * wide)
        stop = int(out[0]) if len(out) else len(z) - 1
        place = int(np.argmin(z[: stop + 1]))
        while place < stop and z[place + 1] - z[place] < _NOSE * abs(y[place + 1] - y[place]):
            place += 1  # the groove below the nose comes forward gently, the nose steeply
        if place > 0:
            found["nose"] = int(vertices[place])
    lip = face.points[found.get("outer_lower", found["inner_lower"])]
    y, z, vertices = face.profile(face.down > 0.4 * face.jaw, lip[1], lip[1] - 1.1 * wide, 60)
    if len(z) > 8:
        hollow = next((k for k in range(1, len(z) - 4) if z[k] <= z[k - 1] and z[k] < z[k + 1 : k + 4].min()), None)
        if hollow is None:  # a chin that recedes all the way
            hollow = int(np.argmin(np.abs(y - (lip[1] - 0.3 * wide))))
        front = hollow + int(np.argmax(z[hollow : hollow + 20]))
        last = front
        while last < len(z) - 1 and z[last + 1] > z[front] - 0.09 * wide:
            last += 1
        found["chin"] = int(vertices[last])


def _faces_away(mesh: Mesh) -> bool:
    """Whether of what opens the middle protrudes further towards -z from the sides than towards z."""
    name = opener(mesh)
    assert name is not None
    size = np.linalg.norm(mesh.shapes[name], axis=1)
    x, _, z = mesh.vertices[size > 0.02 * size.max()].T
    aside = np.abs(x - (x.min() + x.max()) / 2.0) / max(float(np.ptp(x)), _SMALLEST)
    middle, sides = z[aside < 0.15], z[aside > 0.35]
    return bool(len(middle) and len(sides) and sides.min() - middle.min() > middle.max() - sides.max())


def read_head(meshes: List[Mesh], where: str, given: Mapping[str, int]) -> Found:
    """The head of an avatar. `given` are vertices that the user names, by point. Implausible points are omitted, unless
    given, with a warning. Raises DataError for a number that is not a vertex, and if the lips are not found."""
    mesh = choose(meshes, where)
    for point, vertex in given.items():
        if point not in POINTS:
            raise DataError(where, None, f"no point is called {point!r}, there are {', '.join(POINTS)}")
        if not 0 <= vertex < len(mesh.vertices):
            raise DataError(where, None, f"{point}: {vertex} is no vertex of {mesh.name!r}, 0 .. "
                            f"{len(mesh.vertices) - 1}")
    try:
        vertices = find(mesh, where)
    except DataError:
        if not all(point in given for point in NEEDED):
            raise
        vertices = {}
    vertices.update(given)
    doubts: List[str] = []
    at = {point: mesh.vertices[vertex] for point, vertex in vertices.items()}
    if "nose" not in at:
        raise DataError(where, None, "the nose's base was not found: --point nose=VERTEX names it")
    mouth_nose = float(at["nose"][1] - at["inner_upper"][1])
    if not mouth_nose > 0.0:
        raise DataError(where, None, "the nose does not lie above the mouth: --point nose=VERTEX names its base")

    def leave_out(point: str, what: str) -> None:
        if point not in given:
            doubts.append(what)
            del vertices[point]

    for lip in ("upper", "lower"):
        thick = abs(at.get(f"outer_{lip}", at["inner_upper"])[1] - at[f"inner_{lip}"][1]) / mouth_nose
        if f"outer_{lip}" in at and not 0.08 <= thick <= 0.65:
            leave_out(f"outer_{lip}", f"outer {lip} lip: {thick:.2f} of the distance from nose to mouth away from the "
                                      "inner one, which no lip is; left out")
    if "chin" in at:
        below = float(at["inner_lower"][1] - at["chin"][1]) / mouth_nose
        if not 0.9 <= below <= 3.2:
            leave_out("chin", f"chin: {below:.2f} times as far below the mouth as the nose is above; left out")
    else:
        doubts.append("chin: not found; left out")
    if _faces_away(mesh):
        doubts.append("the head seems to face -z: glTF's face z, and of others wrong points are found; turn it round")
    factor, unit = scale_of(mouth_nose)
    if unit == "of unknown size":
        doubts.append("the head is of no human size: millimetres are those of a head with "
                      f"{USUAL_MNS:g} mm from nose to mouth")
    shapes = list(mesh.shapes)
    rest = {point: mesh.vertices[vertex] * factor for point, vertex in vertices.items()}
    moves = {point: np.stack([mesh.shapes[shape][vertex] for shape in shapes]).astype(np.float64) * factor
             for point, vertex in vertices.items()}
    head = from_points(where, shapes, rest, moves)
    apart = float(rest["inner_upper"][1] - rest["inner_lower"][1])
    if apart > _APART:
        doubts.append(f"the inner lips are {apart:.1f} mm apart at rest: p, b, m close no further than shapes can")
    if not 0.8 <= head.mw / head.mns <= 5.0:
        doubts.append(f"the mouth is {head.mw / head.mns:.1f} times as wide as it is away from the nose")
    return Found(head, vertices, factor, doubts, mesh)
