"""Distances between solids, in mm, by the library `coal`: a JSON list of pairs on standard input, a list of distances on standard output.

A solid is [kind, figures, x, y, z, qx, qy, qz, qw]: a box with its edges, a cylinder or a capsule along z with radius and length.
"""

import json
import sys

import coal
import numpy as np


def solid(described):
    kind, figures, x, y, z, *turned = described
    shape = {"box": coal.Box, "cylinder": coal.Cylinder, "capsule": coal.Capsule}[kind](*figures)
    i, j, k, w = turned
    rotation = np.array(
        [
            [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
            [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
            [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
        ]
    )
    place = coal.Transform3s()
    place.setRotation(rotation)
    place.setTranslation(np.array([x, y, z]))
    return shape, place


def distance(pair):
    (one, here), (other, there) = map(solid, pair)
    return coal.distance(one, here, other, there, coal.DistanceRequest(), coal.DistanceResult())


print(json.dumps([distance(pair) for pair in json.load(sys.stdin)]))
