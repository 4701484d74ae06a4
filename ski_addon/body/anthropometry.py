"""Sizes, masses and inertias of a person's segments.

Mass fractions, centres of mass and radii of gyration are de Leva's (1996) adjustments of Zatsiorsky's tables;
segment lengths as fractions of stature are those of Drillis and Contini, the trunk split as de Leva gives it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SegmentTable:
    """One segment of de Leva's tables.

    `mass` is a fraction of body mass, `com` the distance of the centre of mass from the proximal (or cranial) end as
    a fraction of the segment's length, `gyration` the radii about its fore-aft, sideways and long axes as fractions
    of that length, `length` the segment's length as a fraction of stature.
    """

    mass: float
    com: float
    gyration: tuple[float, float, float]
    length: float


_MALE = {
    "head": SegmentTable(0.0694, 0.5976, (0.362, 0.376, 0.312), 0.1168),
    "chest": SegmentTable(0.1596, 0.2999, (0.716, 0.454, 0.659), 0.0980),
    "abdomen": SegmentTable(0.1633, 0.4502, (0.482, 0.383, 0.468), 0.1238),
    "pelvis": SegmentTable(0.1117, 0.6115, (0.615, 0.551, 0.587), 0.0837),
    "upper_arm": SegmentTable(0.0271, 0.5772, (0.285, 0.269, 0.158), 0.186),
    "forearm": SegmentTable(0.0162, 0.4574, (0.276, 0.265, 0.121), 0.146),
    "hand": SegmentTable(0.0061, 0.7900, (0.628, 0.513, 0.401), 0.0494),
    "thigh": SegmentTable(0.1416, 0.4095, (0.329, 0.329, 0.149), 0.245),
    "shank": SegmentTable(0.0433, 0.4395, (0.251, 0.246, 0.102), 0.246),
    "foot": SegmentTable(0.0137, 0.4415, (0.257, 0.245, 0.124), 0.152),
}
_FEMALE = {
    "head": SegmentTable(0.0668, 0.5894, (0.330, 0.359, 0.318), 0.1168),
    "chest": SegmentTable(0.1545, 0.2077, (0.746, 0.502, 0.718), 0.0821),
    "abdomen": SegmentTable(0.1465, 0.4512, (0.433, 0.354, 0.415), 0.1183),
    "pelvis": SegmentTable(0.1247, 0.4920, (0.433, 0.402, 0.444), 0.1046),
    "upper_arm": SegmentTable(0.0255, 0.5754, (0.278, 0.260, 0.148), 0.186),
    "forearm": SegmentTable(0.0138, 0.4559, (0.261, 0.257, 0.094), 0.146),
    "hand": SegmentTable(0.0056, 0.7474, (0.531, 0.454, 0.335), 0.0494),
    "thigh": SegmentTable(0.1478, 0.3612, (0.369, 0.364, 0.162), 0.245),
    "shank": SegmentTable(0.0481, 0.4352, (0.267, 0.263, 0.092), 0.246),
    "foot": SegmentTable(0.0129, 0.4014, (0.299, 0.279, 0.139), 0.152),
}
TABLES: dict[str, dict[str, SegmentTable]] = {"male": _MALE, "female": _FEMALE}
"""de Leva's segments by sex and by the name of the body that carries them."""

PAIRED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
"""Segments that exist left and right."""


@dataclass(frozen=True)
class Segment:
    """A segment of one person: `mass` [kg], `length` [m], distance `com` of its centre of mass from the proximal end
    [m] and principal moments `inertia` about its fore-aft, sideways and long axes [kg m^2].
    """

    mass: float
    length: float
    com: float
    inertia: tuple[float, float, float]


def person_segments(mass: float, height: float, sex: str) -> dict[str, Segment]:
    """Return the segments, by body name, of a person of `mass` [kg] without equipment and stature `height` [m].

    Fractions are normalised so that all segments add up to `mass` exactly (the tables sum to .999 to 1.000).
    """
    table = TABLES[sex]
    total = sum(entry.mass * (2 if name in PAIRED else 1) for name, entry in table.items())
    segments = {}
    for name, entry in table.items():
        m, length = mass * entry.mass / total, height * entry.length
        inertia = tuple(m * (radius * length) ** 2 for radius in entry.gyration)
        segments[name] = Segment(m, length, entry.com * length, (inertia[0], inertia[1], inertia[2]))
    return segments
