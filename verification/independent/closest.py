"""The point of a triangle nearest to another point; signed distance to a closed mesh."""

import math

import numpy as np


def nearest_on_edge(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    along = (p - a) @ (b - a) / ((b - a) @ (b - a))
    return a + min(max(along, 0.0), 1.0) * (b - a)


def weights_of(corners: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Of the corners (3 x 3), for the foot of p in the triangle's plane; they sum to one."""
    a, b, c = corners
    normal = np.cross(b - a, c - a)
    size = normal @ normal
    second, third = np.cross(p - a, c - a) @ normal / size, np.cross(b - a, p - a) @ normal / size
    return np.array([1 - second - third, second, third])


def nearest_on_triangle(corners: np.ndarray, p: np.ndarray) -> np.ndarray:
    weights = weights_of(corners, p)
    if np.all(weights >= 0):
        return weights @ corners
    feet = [nearest_on_edge(p, corners[i], corners[(i + 1) % 3]) for i in range(3)]
    return min(feet, key=lambda foot: float(np.linalg.norm(p - foot)))


def solid_angle(corners: np.ndarray, p: np.ndarray) -> float:
    """Of a triangle seen from p, positive from behind (van Oosterom and Strackee 1983)."""
    a, b, c = corners - p
    la, lb, lc = np.linalg.norm(corners - p, axis=1)
    below = la * lb * lc + (a @ b) * lc + (b @ c) * la + (c @ a) * lb
    return 2 * math.atan2(a @ np.cross(b, c), below)


def signed_distance(triangles: np.ndarray, p: np.ndarray) -> tuple[float, np.ndarray]:
    """To a closed mesh of outward triangles (M x 3 x 3), negative inside; and its gradient. Over a
    face that is the face's normal, which keeps its digits on the surface."""
    feet = [nearest_on_triangle(corners, p) for corners in triangles]
    nearest = min(range(len(feet)), key=lambda number: float(np.linalg.norm(p - feet[number])))
    turns = sum(solid_angle(corners, p) for corners in triangles) / (4 * math.pi)
    side = -1.0 if turns > 0.5 else 1.0
    away = p - feet[nearest]
    corners = triangles[nearest]
    if np.all(weights_of(corners, p) >= 0):
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal /= np.linalg.norm(normal)
        return float(away @ normal), normal
    return side * float(np.linalg.norm(away)), side * away / np.linalg.norm(away)
