"""A room of upright walls, exact ranges and depth images of it, and how well a map shows it. Metres, radians; world frame."""
import copy
import math

import numpy

from chain import Pose2
from programs import rotation

WIDTH, HEIGHT, FOCAL_PX = 160, 120, 80.0
CAMERA_HEIGHT_M, LASER_FORWARD_M = 0.4, 0.1
CEILING_M = 2.5
# Optical frame (x right, y down, z forward) in the base frame.
BASE_FROM_CAMERA = numpy.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]])


def rectangle(x0, y0, x1, y1, z_max=CEILING_M):
    return [(x0, y0, x1, y0, z_max), (x1, y0, x1, y1, z_max), (x1, y1, x0, y1, z_max), (x0, y1, x0, y0, z_max)]


class Room:
    """6 m x 4 m with a cupboard 1.4 m high in one corner."""

    def __init__(self):
        self.outer = rectangle(0, 0, 6, 4)
        self.cupboard = rectangle(5.0, 2.8, 5.8, 3.8, 1.4)

    def seen_from_the_middle(self):
        """The outer walls without what the cupboard hides, and its two faces."""
        return [(0, 0, 6, 0), (6, 0, 6, 2.5), (4.7, 4, 0, 4), (0, 4, 0, 0), (5, 2.8, 5.8, 2.8), (5, 3.8, 5, 2.8)]

    def cast(self, origin, rays):
        """How many times its ray each nearest surface is away; infinity where there is none."""
        with numpy.errstate(divide="ignore", invalid="ignore"):
            nearest = numpy.where(rays[:, 2] < 0, -origin[2] / rays[:, 2], (CEILING_M - origin[2]) / rays[:, 2])
            nearest[rays[:, 2] == 0] = math.inf
            for x0, y0, x1, y1, z_max in self.outer + self.cupboard:
                ex, ey, wx, wy = x1 - x0, y1 - y0, x0 - origin[0], y0 - origin[1]
                cross = rays[:, 0] * ey - rays[:, 1] * ex
                away = (wx * ey - wy * ex) / cross
                share = (wx * rays[:, 1] - wy * rays[:, 0]) / cross
                z = origin[2] + away * rays[:, 2]
                hit = (away > 1e-6) & (share >= 0) & (share <= 1) & (z >= 0) & (z <= z_max)
                nearest = numpy.where(hit, numpy.minimum(nearest, away), nearest)
        return nearest

    def laser_ranges(self, pose, bearings):
        """Of a level laser 0.3 m above the floor and LASER_FORWARD_M before the base's origin."""
        laser = pose * Pose2(LASER_FORWARD_M, 0, 0)
        rays = numpy.stack([numpy.cos(laser.yaw + bearings), numpy.sin(laser.yaw + bearings), 0 * bearings], 1)
        return self.cast((laser.x, laser.y, 0.3), rays)

    def depth_image(self, pose, pitch=0.0, height=CAMERA_HEIGHT_M):
        """Z in m of a camera so high above the base's origin of a robot that pitches down by so much."""
        c, s, cp, sp = math.cos(pose.yaw), math.sin(pose.yaw), math.cos(pitch), math.sin(pitch)
        world_from_base = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ numpy.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        v, u = numpy.mgrid[0:HEIGHT, 0:WIDTH]
        in_camera = numpy.stack([(u - (WIDTH - 1) / 2) / FOCAL_PX, (v - (HEIGHT - 1) / 2) / FOCAL_PX, numpy.ones(u.shape)], -1)
        rays = in_camera.reshape(-1, 3) @ (world_from_base @ BASE_FROM_CAMERA).T
        origin = numpy.array([pose.x, pose.y, 0]) + world_from_base @ numpy.array([0, 0, height])
        return self.cast(origin, rays).reshape(HEIGHT, WIDTH)

    def distance(self, x, y, walls=None):
        nearest = numpy.full(numpy.shape(x), math.inf)
        for x0, y0, x1, y1, *_ in walls or self.outer + self.cupboard:
            ex, ey = x1 - x0, y1 - y0
            share = numpy.clip(((x - x0) * ex + (y - y0) * ey) / (ex * ex + ey * ey), 0, 1)
            nearest = numpy.minimum(nearest, numpy.hypot(x0 + share * ex - x, y0 + share * ey - y))
        return nearest


def circle(steps=70):
    """Poses along a circle of 0.7 m around the middle, looking along it."""
    return [Pose2(2.7 + 0.7 * math.sin(a), 2 - 0.7 * math.cos(a), a) for a in numpy.linspace(0, 2.2 * math.pi, steps)]


def tilted(pose, pitch):
    """Quaternion of a base that heads along pose.yaw and pitches down."""
    return rotation(0, pitch, pose.yaw)


def followed(maps, updates):
    """The newest whole map with the updates that came after it, as those who subscribe to both have it."""
    grid = copy.deepcopy(maps[-1])
    values = numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)
    for update in updates:
        if update.header.stamp > grid.header.stamp:
            part = numpy.array(update.data, numpy.int8).reshape(update.height, update.width)
            values[update.y:update.y + update.height, update.x:update.x + update.width] = part
    grid.data = values.ravel().tolist()
    return grid


class SeenMap:
    """Occupied and free cells of a nav_msgs/OccupancyGrid in the world; start: world_from_map."""

    def __init__(self, grid, start):
        values = numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)
        rows, cols = numpy.mgrid[0:grid.info.height, 0:grid.info.width]
        x = grid.info.origin.position.x + (cols + 0.5) * grid.info.resolution
        y = grid.info.origin.position.y + (rows + 0.5) * grid.info.resolution
        c, s = math.cos(start.yaw), math.sin(start.yaw)
        self.x, self.y = start.x + c * x - s * y, start.y + s * x + c * y
        self.occupied, self.free = values > 65, (values >= 0) & (values < 20)

    def count(self):
        return int(self.occupied.sum())

    def precision(self, room, walls=None):
        """Share of the occupied cells within 0.1 m of a wall."""
        return float((room.distance(self.x[self.occupied], self.y[self.occupied], walls) <= 0.1).mean())

    def recall(self, walls, within=0.1):
        """Share of the walls that have an occupied cell near."""
        shown = []
        for x0, y0, x1, y1, *_ in walls:
            for share in numpy.linspace(0.05, 0.95, 40):
                px, py = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
                near = numpy.hypot(self.x[self.occupied] - px, self.y[self.occupied] - py)
                shown.append(near.size > 0 and near.min() <= within)
        return float(numpy.mean(shown))

    def occupied_within(self, x0, y0, x1, y1):
        return int((self.occupied & (self.x > x0) & (self.x < x1) & (self.y > y0) & (self.y < y1)).sum())
