"""Bodies, clips, garments and materials from arrays."""

import numpy as np
import pytest

import selvedge


def tube(radius, low, high, rings, around):
    """An open tube round the y axis: positions and triangles, counter-clockwise seen from outside."""
    angles = 2 * np.pi * np.arange(around) / around
    x = np.array([[radius * np.cos(a), y, radius * np.sin(a)] for y in np.linspace(low, high, rings) for a in angles])
    triangles = []
    for r in range(rings - 1):
        for k in range(around):
            a, b = r * around + k, r * around + (k + 1) % around
            triangles += [(a, a + around, b), (b, a + around, b + around)]
    return x, np.array(triangles)


def limb():
    """A closed cylinder of two joints, one on top of the other, whose upper half follows the second."""
    x, triangles = tube(0.05, 0.0, 0.6, 13, 12)
    ends = np.array([[0, 0, 0], [0, 0.6, 0.0]])
    caps = [(156, k, (k + 1) % 12) for k in range(12)] + [(157, 144 + (k + 1) % 12, 144 + k) for k in range(12)]
    x, triangles = np.vstack([x, ends]), np.vstack([triangles, caps])
    upper = np.clip((x[:, 1] - 0.2) / 0.2, 0, 1)
    return x, triangles, [[0, 0, 0], [0, 0.3, 0]], np.stack([1 - upper, upper], axis=1), [-1, 0]


def bending(frames, angle=0.5):
    poses = np.zeros((frames, 2, 3))
    poses[:, 1, 2] = np.linspace(0, angle, frames)
    return poses


def test_a_body_moves_as_its_clip_says():
    scene = selvedge.Scene()
    scene.add_cloth([[1, 0, 0], [1, 0, 1], [2, 0, 0]], [[0, 1, 2]])
    moves = np.zeros((31, 3))
    moves[:, 0] = np.linspace(0, 0.3, 31)
    clip = {"poses": bending(31), "translations": moves, "fps": 30}
    assert scene.add_body(*limb(), **clip, name="limb", room=0, translate=[0, -1, 0]) == 0
    assert scene.obstacles[0]["x"] == pytest.approx(limb()[0] - [0, 1, 0])
    selvedge.simulate(scene, 30)
    x, _, _, weights, _ = limb()
    c, s = np.cos(0.5), np.sin(0.5)
    turned = (x - [0, 0.3, 0]) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [0, 0.3, 0]
    expected = weights[:, :1] * x + weights[:, 1:] * turned + [0.3, -1, 0]
    assert scene.obstacles[0]["x"] == pytest.approx(expected, abs=1e-9)
    with pytest.raises(selvedge.Error, match="its clip moves"):
        scene.move_obstacle(0, x)


def test_a_garment_is_worn_and_goes_along():
    def dressed(**more):
        scene = selvedge.Scene()
        scene.add_body(*limb(), poses=bending(16), name="limb")
        x, triangles = tube(0.06, 0.15, 0.55, 15, 18)
        top = [v for v in range(len(x)) if x[v, 1] > 0.549]
        material = {"name": "cotton", "density": 0.15}
        assert scene.add_garment(x, triangles, name="sleeve", pins=top, material=material, **more) == 0
        return scene, x, top

    scene, x, top = dressed()
    assert scene.x == pytest.approx(x, abs=1e-6)
    selvedge.simulate(scene, 15)
    assert scene.clean and np.isfinite(scene.x).all()
    _, _, _, weights, _ = limb()
    c, s = np.cos(0.5), np.sin(0.5)
    turned = (x[top] - [0, 0.3, 0]) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [0, 0.3, 0]
    assert scene.x[top] == pytest.approx(turned, abs=5e-3)  # pins follow the body's upper end, where weights are 1
    draped, _, _ = dressed(start={"from": "draped", "seconds": 0.2, "hold": 0.1})
    assert draped.frame == 0 and draped.time == 0 and draped.x[:, 1].min() < x[:, 1].min() - 1e-4


def test_mistakes_say_what_and_where():
    scene = selvedge.Scene()
    x, triangles, joints, weights, parents = limb()
    sleeve = tube(0.06, 0.15, 0.55, 5, 12)

    def refused(words, call, *arguments, **keys):
        with pytest.raises(selvedge.Error) as error:
            call(*arguments, **keys)
        assert all(word in str(error.value) for word in words), str(error.value)

    refused(["garment `g`", "no body"], scene.add_garment, *sleeve, name="g")
    body = scene.add_body
    far = {"poses": np.zeros((2, 2, 3)), "translations": [[0, 0, 0], [0, 1e7, 0]]}
    uneven = {"poses": np.zeros((4, 2, 3)), "translations": np.zeros((3, 3))}
    refused(["body `b`, weights", "158 x 2"], body, x, triangles, joints, weights[:5], parents, name="b")
    refused(["weights", "sums to"], body, x, triangles, joints, 0.9 * weights, parents)
    refused(["parents", "-1"], body, x, triangles, joints, weights, [0, -1])
    refused(["parents", "3 numbers"], body, x, triangles, joints, weights, [-1, 0, 1])
    refused(["poses", "frames x joints x 3"], body, x, triangles, joints, weights, parents, poses=np.zeros((4, 3, 3)))
    refused(["poses", "(4, 2)"], body, x, triangles, joints, weights, parents, poses=np.zeros((4, 2)))
    refused(["translations", "3 rows for 4"], body, x, triangles, joints, weights, parents, **uneven)
    refused(["translations", "row 1"], body, x, triangles, joints, weights, parents, **far)
    refused(["fps", "is 0"], body, x, triangles, joints, weights, parents, poses=np.zeros((4, 2, 3)), fps=0)
    refused(["`translat`", "translate"], body, x, triangles, joints, weights, parents, translat=[0, 0, 0])
    refused(["without poses"], body, x, triangles, joints, weights, parents, translations=[[0, 0, 0]])
    scene.add_body(x, triangles, joints, weights, parents, name="limb", room=0)
    refused(["is not worn"], scene.add_garment, sleeve[0] + [5, 0, 0], sleeve[1])
    refused(["`lim`", "limb"], scene.add_garment, *sleeve, on="lim")
    refused(["pins", "vertex 60"], scene.add_garment, *sleeve, pins=[60])
    refused(["fit", "tigth"], scene.add_garment, *sleeve, fit="tigth")
    refused(["start.from", "drapd", "draped"], scene.add_garment, *sleeve, start={"from": "drapd"})
    refused(["garment", "leave it out"], scene.add_garment, *sleeve, garment={"fit": "tight"})
    refused(["body", "leave it out"], body, x, triangles, joints, weights, parents, body={"clip": "walk"})


def test_materials_are_those_of_scene_files(tmp_path):
    x, triangles = tube(0.2, 0, 0.4, 5, 12)
    named, given = selvedge.Scene(), selvedge.Scene()
    named.add_cloth(x, triangles, material="denim")
    keys = {"density": np.float32(0.5), "bending": "1e-4 N m", "youngs_modulus": 900, "poisson": 0.25}
    given.add_cloth(x, triangles, material=keys)
    by_number = selvedge.Scene()
    by_number.add_cloth(x, triangles, density=0.5, bending=1e-4, youngs_modulus=900, poisson=0.25)
    for scene in (named, given, by_number):
        selvedge.simulate(scene, 3)
    assert (given.x == by_number.x).all() and not (named.x == given.x).all()
    for material, words in [
        ("denmi", ["denmi", "denim"]),
        ({"density": -1}, ["cloth `cloth`, material", "density", "-1"]),
        ({"densty": 1}, ["densty", "density"]),
        ({"density": object()}, ["cannot say"]),
        ({"poisson": 0.3}, ["stands alone"]),
    ]:
        with pytest.raises(selvedge.Error) as error:
            selvedge.Scene().add_cloth(x, triangles, material=material)
        assert all(word in str(error.value) for word in words), str(error.value)
    with pytest.raises(selvedge.Error, match="beside numbers"):
        selvedge.Scene().add_cloth(x, triangles, material="denim", density=1)


def test_pins_stay_where_they_are():
    scene = selvedge.Scene()
    x, triangles = tube(0.2, 0, 0.4, 5, 12)
    scene.add_cloth(x + [0, 5, 0], triangles)
    scene.add_cloth(x, triangles, pins=[50, 48, 49, 48])
    selvedge.simulate(scene, 10)
    assert (scene.x[60 + np.array([48, 49, 50])] == x[48:51]).all() and scene.x[60:, 1].min() < -0.01


def loose_box(gap):
    """A box of faces that share no vertex, 0.1 m long; `gap`: how far its lid is off [m]."""
    x, triangles = [], []
    for axis in range(3):
        for side in (0, 1):
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = np.zeros(3)
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = side, *((u, v) if side else (v, u))
                x.append(0.1 * corner + [0, gap if axis == 1 and side else 0, 0])
            n = len(x) - 4
            triangles += [(n, n + 1, n + 2), (n, n + 2, n + 3)]
    return np.array(x), np.array(triangles)


@pytest.mark.parametrize("gap, closed", [(0, True), (1e-4, True), (0.01, False)])
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_seams_of_arrays_are_closed_as_those_of_files(gap, closed):
    x, triangles = loose_box(gap)
    cloth = [[0.03, 0.05, 0.03], [0.06, 0.05, 0.03], [0.03, 0.05, 0.06]]
    assert selvedge.check(cloth, [[0, 1, 2]], [(x, triangles)])["inside_vertices"] == (3 if closed else 0)
    for add in (
        lambda scene: scene.add_obstacle(x, triangles),
        lambda scene: scene.add_body(x, triangles, [[0.05, 0, 0.05]], np.ones((24, 1)), [-1]),
    ):
        scene = selvedge.Scene()
        add(scene)
        edges = np.sort(scene.obstacles[0]["triangles"][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2))
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all() == closed


def test_a_seam_of_an_obstacle_may_open_by_a_rounding_alone():
    scene = selvedge.Scene()
    scene.add_cloth([[1, 0, 0], [1, 0, 1], [2, 0, 0]], [[0, 1, 2]])
    scene.add_obstacle(*loose_box(1e-4))
    scene.step()
    scene.move_obstacle(0, loose_box(5e-4)[0])
    with pytest.raises(selvedge.Error, match="opens a seam"):
        scene.move_obstacle(0, loose_box(0.01)[0])


def test_distance_names_triangles_as_they_were_given():
    x, triangles = loose_box(0)
    first = [[0, 8, 5], [0, 1, 2]]  # one whose corners lie at two places, and one that is there again
    found = selvedge.distance([[0.05, 0.2, 0.05]], x, np.vstack([first, triangles]))
    assert found["triangle"][0] in (8, 9)
