"""The balanced centre of mass against what can be derived by hand."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.frames import rotation_about
from ski_addon.planning.differences import Differences
from ski_addon.planning.line import Line
from ski_addon.planning.pendulum import Legs, balanced_pendulum, speed_for_lean

G, LENGTH = 9.81, 0.85
TIME = np.arange(0.0, 4.0, 0.005)
ONES = np.ones_like(TIME)
DIFFERENCES = Differences(TIME)


def line(curvature, speed, left=0.0, into=G, **more) -> Line:
    """A line of `curvature` at `speed`; whatever else a line has is zero unless given."""
    given = {"time": TIME, "curvature": curvature, "speed": speed, "gravity_left": left, "gravity_into": into, **more}
    vectors = ("position", "tangent", "surface_normal", "body_frame", "spin", "pull")
    flat = {name: given.get(name, 0.0) * ONES for name in Line.__dataclass_fields__ if name not in vectors}
    v, sine, cosine = flat["speed"], np.sin(flat["steering"]), np.cos(flat["steering"])
    kappa, hollow, torsion = flat["curvature"], flat["normal_curvature"], flat["torsion"]
    spin = (v * (torsion * cosine - hollow * sine), -v * (hollow * cosine + torsion * sine))
    pull = (
        (flat["gravity_along"] - flat["acceleration"]) * cosine + (flat["gravity_left"] - kappa * v**2) * sine,
        (flat["gravity_left"] - kappa * v**2) * cosine - (flat["gravity_along"] - flat["acceleration"]) * sine,
        -flat["gravity_into"] - hollow * v**2,
    )
    level = np.broadcast_to(np.eye(3), (len(TIME), 3, 3))
    return Line(
        **flat,
        position=np.zeros((len(TIME), 3)),
        tangent=level[..., 0],
        surface_normal=level[..., 2],
        body_frame=level,
        spin=np.stack((*spin, kappa * v + flat["steering_rate"]), axis=1),
        pull=np.stack(pull, axis=1),
    )


def legs(least_load=0.25, extension=0.1, rise=0.0) -> Legs:
    return Legs(LENGTH, extension, 0.2, least_load, rise * ONES)


def pendulum(curvature, speed, left=0.0, into=G, **more):
    return balanced_pendulum(line(curvature, speed, left, into, **more), legs())


@pytest.mark.parametrize(("speed", "radius"), [(5.0, 15.0), (9.0, 15.0), (9.0, -10.0), (12.0, 25.0)])
def test_claim_17_lean_of_a_steady_turn(speed, radius):
    """tan(lean) = u^2 / (g R) of the centre of mass's own speed u and radius R; both are smaller than the skis'."""
    steady = pendulum(1.0 / radius, speed)
    middle = len(TIME) // 2
    own_radius = radius - steady.y[middle]
    own_speed = speed * own_radius / radius
    assert np.tan(steady.inclination[middle]) == pytest.approx(own_speed**2 / (G * own_radius), rel=1e-6)
    assert np.hypot(steady.y[middle], steady.h[middle]) == pytest.approx(LENGTH, rel=1e-9)
    assert steady.normal[middle] == pytest.approx(G)


def test_claim_17_paper_limit():
    """tan(lean) = v^2 / (g r) [SG19 Eq. 7] when the circle is large against the skier."""
    steady = pendulum(1.0 / 1000.0, 40.0)
    assert np.tan(steady.inclination[400]) == pytest.approx(40.0**2 / (G * 1000.0), rel=1e-3)


@pytest.mark.parametrize("degrees", [-20.0, 8.0, 30.0])
def test_claim_17_traverse(degrees):
    """Straight across a slope the skier stands upright in the world: leaning from the snow's normal by the slope."""
    slope = np.deg2rad(degrees)
    still = pendulum(0.0, 6.0, left=G * np.sin(slope), into=G * np.cos(slope))
    np.testing.assert_allclose(still.inclination, -slope, atol=1e-6)


def test_claim_17_straight_on_flat_ground_is_upright():
    still = pendulum(0.0, 6.0)
    np.testing.assert_allclose(still.y, 0.0, atol=1e-12)
    np.testing.assert_allclose(still.h, LENGTH, atol=1e-12)


def swinging(least_load=0.0, quick=0.12, bend=0.1, speed=9.0, extension=0.1):
    """A turn to the left that changes to the right at 2 s, within about 3 `quick` seconds."""
    curvature = -bend * np.tanh((TIME - 2.0) / quick)
    return curvature, balanced_pendulum(line(curvature, speed), legs(least_load, extension))


def test_pendulum_obeys_its_equation_of_motion():
    """y'' = (normal / h + (kappa v)^2) y + g_left - kappa v^2, with h'' in the normal force; by finite differences."""
    curvature, swing = swinging()
    left_hand = DIFFERENCES.second(swing.y)
    right_hand = (swing.normal / swing.h + (curvature * 9.0) ** 2) * swing.y - curvature * 81.0
    np.testing.assert_allclose(left_hand[3:-3], right_hand[3:-3], atol=1e-4)
    np.testing.assert_allclose(G + DIFFERENCES.second(swing.h)[3:-3], swing.normal[3:-3], atol=1e-6)
    np.testing.assert_allclose(np.gradient(swing.y, TIME)[3:-3], swing.y_rate[3:-3], atol=1e-9)
    np.testing.assert_allclose(np.gradient(swing.h, TIME)[3:-3], swing.h_rate[3:-3], atol=1e-9)


def test_pendulum_anticipates():
    """A bounded pendulum moves before its turn does: it crosses with the turn's change, and starts to move earlier."""
    curvature, swing = swinging()
    assert abs(np.interp(2.0, TIME, swing.y)) < 1e-3
    before = np.searchsorted(TIME, 1.6)
    steady_left = pendulum(0.1, 9.0).y[400]
    assert curvature[before] > 0.99 * 0.1 and swing.y[before] < 0.9 * steady_left


@pytest.mark.parametrize("least", [0.5, 0.8])
def test_load_never_falls_below_what_is_asked(least):
    """A rigid leg would be unloaded by a quick change of edges; the legs bend and stretch to keep the load."""
    rigid, kept = swinging()[1], swinging(least_load=least)[1]
    assert rigid.normal.min() < 0.8 * G, "the case is too easy to test anything"
    assert kept.normal.min() >= least * G
    assert np.all(np.hypot(kept.y, kept.h) <= LENGTH + 0.1 + 1e-6)


def test_extension_is_the_limit_of_the_legs():
    _, kept = swinging(least_load=0.9, extension=0.01, speed=10.0)
    assert np.hypot(kept.y, kept.h).max() <= LENGTH + 0.01 + 1e-3


def test_mirrored_turn_gives_the_mirrored_lean():
    bend = 0.1 * np.sin(2.0 * TIME) + 0.02
    left, right = (pendulum(side * bend, 8.0, left=side * 0.3) for side in (1, -1))
    np.testing.assert_allclose(left.y, -right.y, atol=1e-12)
    np.testing.assert_allclose(left.h, right.h, atol=1e-12)


@pytest.mark.parametrize("left", [-1.5, 0.0, 1.5])
@pytest.mark.parametrize("bend", [-0.1, 0.04])
def test_speed_for_a_lean_is_the_way_back(bend, left):
    lean = np.deg2rad(35.0)
    speed = speed_for_lean(np.sign(bend) * lean, np.array([bend]), np.array([left]), np.array([G]), LENGTH)[0]
    steady = pendulum(bend, speed, left=left)
    assert abs(steady.inclination[400]) == pytest.approx(lean, rel=1e-6)


def test_speed_for_a_lean_where_the_track_does_not_ask_for_one():
    """Any speed will do on a straight, or where the track bends away; none where gravity alone asks for more."""
    bends, pulls = np.array([0.0, -0.1, 0.1]), np.array([0.0, 0.0, -30.0])
    speeds = speed_for_lean(0.5, bends, pulls, np.full(3, G), LENGTH)
    np.testing.assert_array_equal(speeds, [np.inf, np.inf, 0.0])


# -- any ground, skidding ------------------------------------------------------------


def accelerations(ridden: Line, swing) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Acceleration of the centre of mass along the skis, across and up, by numeric integration of the skis' frame and
    second differences of the world position; the pivot starts at the origin.
    """
    step = TIME[1] - TIME[0]
    frame, place = np.eye(3), np.zeros(3)
    frames, places = [], []
    spin_along = ridden.speed[:, None] * np.stack((ridden.torsion, -ridden.normal_curvature, ridden.curvature), axis=1)
    for i in range(len(TIME)):
        frames.append(frame)
        places.append(place)
        middle = 0.5 * (spin_along[i] + spin_along[min(i + 1, len(TIME) - 1)])
        half = frame @ rotation_vector(0.5 * step * middle)
        speed = 0.5 * (ridden.speed[i] + ridden.speed[min(i + 1, len(TIME) - 1)])
        place = place + step * speed * half[:, 0]
        frame = frame @ rotation_vector(step * middle)
    track = np.array(frames)
    skis = track @ rotation_about("z", ridden.steering)
    com = np.array(places) + swing.y[:, None] * skis[..., 1] + swing.h[:, None] * skis[..., 2]
    second = np.array([DIFFERENCES.second(com[:, axis]) for axis in range(3)]).T
    return tuple(np.sum(second * skis[..., axis], axis=1) for axis in range(3))


def rotation_vector(vector):
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(vector).as_matrix()


UNEVEN = {
    "torsion": 0.02 * np.sin(1.3 * TIME),
    "normal_curvature": 0.03 * np.cos(2.1 * TIME),
    "steering": 0.3 * np.sin(0.9 * TIME) ** 2,
    "steering_rate": 0.54 * np.sin(0.9 * TIME) * np.cos(0.9 * TIME),
    "acceleration": 0.8 * ONES,
}


@pytest.mark.parametrize("name", ["plane", "torsion", "normal_curvature", "steering", "acceleration", "all"])
def test_force_on_any_ground_points_from_the_skis_through_the_body(name):
    """Against the motion itself: the frame is integrated and the world path differentiated twice."""
    more = {} if name == "plane" else UNEVEN if name == "all" else {name: UNEVEN[name]}
    if "steering" in more:
        more["steering_rate"] = UNEVEN["steering_rate"]
    speed = 7.0 + (0.8 * TIME if "acceleration" in more else 0.0)
    ridden = line(0.08 * np.sin(1.7 * TIME), speed * ONES, left=0.4, **more)
    swing = balanced_pendulum(ridden, legs(least_load=0.0))
    along, across, up = accelerations(ridden, swing)
    inner = slice(20, -20)
    np.testing.assert_allclose((up + G)[inner], swing.normal[inner], atol=0.03)
    pull = 0.4 * np.cos(ridden.steering)
    np.testing.assert_allclose((across - pull)[inner], (swing.normal * swing.y / swing.h)[inner], atol=0.03)
    moved = ridden.acceleration * np.cos(ridden.steering) + ridden.curvature * speed**2 * np.sin(ridden.steering)
    np.testing.assert_allclose(along[inner], (moved + swing.swing)[inner], atol=0.03)


@pytest.mark.parametrize("lean", [50.0, 58.0, 64.0])
def test_deep_leans_are_found(lean):
    """The undamped iteration diverges beyond 45 degrees: the height falls as the lean grows."""
    bend = 1.0 / 16.0
    speed = speed_for_lean(np.deg2rad(lean), np.array([bend]), np.zeros(1), np.array([G]), LENGTH)[0]
    assert np.rad2deg(pendulum(bend, speed).inclination[400]) == pytest.approx(lean, abs=1e-4)


def test_swing_from_deep_lean_to_deep_lean_is_balanced():
    curvature = -np.tanh((TIME - 2.0) / 0.35) / 16.0
    deep = balanced_pendulum(line(curvature, 15.5), legs())
    assert np.rad2deg(deep.inclination.max()) > 54 and np.rad2deg(deep.inclination.min()) < -54
    assert deep.normal.min() >= 0.25 * G
    right_hand = (deep.normal / deep.h + (curvature * 15.5) ** 2) * deep.y - curvature * 15.5**2
    np.testing.assert_allclose(DIFFERENCES.second(deep.y)[3:-3], right_hand[3:-3], atol=2e-2)


def test_a_stop_leans_back_against_the_motion():
    """Skis across the track (90 degrees left): the body leans to their left, uphill, by its deceleration."""
    stop = pendulum(0.0, 5.0, steering=np.pi / 2, acceleration=-4.0)
    assert np.tan(stop.inclination[400]) == pytest.approx(4.0 / G, rel=1e-6)


def test_standing_across_a_slope_is_upright_in_the_world():
    slope = np.deg2rad(20)
    still = pendulum(0.0, 0.0, into=G * np.cos(slope), gravity_along=G * np.sin(slope), steering=np.pi / 2)
    assert still.inclination[400] == pytest.approx(slope, rel=1e-6)


def test_legs_that_stand_higher_keep_the_lean():
    low, high = (balanced_pendulum(line(0.08, 8.0), legs(rise=rise)) for rise in (-0.1, 0.05))
    assert high.h[400] > low.h[400]
    assert high.inclination[400] == pytest.approx(low.inclination[400], abs=0.05)


def test_height_that_follows_a_wave_loads_and_unloads():
    rise = 0.05 * np.sin(4.0 * TIME)
    wave = balanced_pendulum(line(0.0, 5.0), Legs(LENGTH, 0.1, 0.2, 0.0, rise))
    np.testing.assert_allclose(wave.normal[5:-5], (G - 0.05 * 16.0 * np.sin(4.0 * TIME))[5:-5], atol=1e-3)
