"""The points of triangles nearest to another point; signed distance to a closed mesh.

Triangles are M x 3 x 3: corners a, b, c of each."""

import math

import numpy as np


def weights_of(triangles: np.ndarray, p: np.ndarray) -> np.ndarray:
    """M x 3: of the corners, for the foot of p in each triangle's plane; they sum to one."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    size = np.sum(normal * normal, axis=1)
    second = np.sum(np.cross(p - a, c - a) * normal, axis=1) / size
    third = np.sum(np.cross(b - a, p - a) * normal, axis=1) / size
    return np.stack([1 - second - third, second, third], axis=1)


def nearest_on_edges(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """M x 3."""
    along = np.sum((p - a) * (b - a), axis=1) / np.sum((b - a)**2, axis=1)
    return a + np.clip(along, 0, 1)[:, None] * (b - a)


def nearest_on(triangles: np.ndarray, p: np.ndarray) -> np.ndarray:
    """M x 3: of each triangle the point nearest to p."""
    weights = weights_of(triangles, p)
    feet = np.einsum("mi,mij->mj", weights, triangles)
    rim = np.stack([nearest_on_edges(p, triangles[:, i], triangles[:, (i + 1) % 3])
                    for i in range(3)], axis=1)  # M x 3 edges x 3
    best = np.argmin(np.linalg.norm(p - rim, axis=2), axis=1)
    outside = np.any(weights < 0, axis=1)
    feet[outside] = rim[np.arange(len(rim)), best][outside]
    return feet


def solid_angles(triangles: np.ndarray, p: np.ndarray) -> np.ndarray:
    """M, seen from p, positive from behind (van Oosterom and Strackee 1983)."""
    a, b, c = (triangles[:, i] - p for i in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    below = (la * lb * lc + np.sum(a * b, axis=1) * lc + np.sum(b * c, axis=1) * la
             + np.sum(c * a, axis=1) * lb)
    return 2 * np.arctan2(np.sum(a * np.cross(b, c), axis=1), below)


def signed_distance(triangles: np.ndarray, p: np.ndarray) -> tuple[float, np.ndarray]:
    """To a closed mesh of outward triangles, negative inside; and its gradient. Over a face that is
    the face's normal, which keeps its digits on the surface."""
    feet = nearest_on(triangles, p)
    nearest = int(np.argmin(np.linalg.norm(p - feet, axis=1)))
    away = p - feet[nearest]
    if np.all(weights_of(triangles[nearest:nearest + 1], p) >= 0):
        a, b, c = triangles[nearest]
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        return float(away @ normal), normal
    side = -1.0 if solid_angles(triangles, p).sum() > 2 * math.pi else 1.0
    return side * float(np.linalg.norm(away)), side * away / np.linalg.norm(away)
