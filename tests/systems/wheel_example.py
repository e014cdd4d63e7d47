"""What a user of the wheel does first, with answers that are known: a box over a plate. Exits 1 where one is wrong."""

import numpy as np

import nearfit


def box(size):
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    triangles = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    return nearfit.Mesh(corners * np.asarray(size), triangles)


scene = nearfit.Scene()
scene.add(box((0.2, 0.2, 0.02)), "plate")
scene.add(box((0.02, 0.02, 0.04)), "block", pose=(0, 0, 0.1, 1, 0, 0, 0))

# The block's foot goes from 70 mm over the plate to 10 mm below its face.
heights = np.linspace(0.1, 0.02, 1001)
poses = np.tile(np.eye(4), (len(heights), 1, 1))
poses[:, 2, 3] = heights
gaps = heights - 0.03
clear = gaps > 1e-9

distances = nearfit.distance(scene, "block", poses)
assert np.allclose(distances[clear], gaps[clear], atol=1e-12), "distances"
assert np.all(distances[gaps < -1e-9] == 0.0), "distances of a block in the plate"
assert np.array_equal(nearfit.overlap(scene, "block", poses)[np.abs(gaps) > 1e-9], (gaps < 0.0)[np.abs(gaps) > 1e-9]), "overlap"

minima = nearfit.lmds(scene, "block", poses[:100], 0.08)
assert np.allclose([minima[i].distances.min() for i in range(100)], gaps[:100], atol=1e-12), "minima"

findings = nearfit.clearance(scene, 0.08)
assert len(findings) == 1 and abs(findings[0].distance - 0.07) < 1e-12, "clearance"

print(f"nearfit {nearfit.__version__} with NumPy {np.__version__}: {len(heights)} poses, all answers right")
