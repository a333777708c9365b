"""WHAT EXISTS: disks, walls and a domain make a scene, in code or from a file; nothing here ever changes."""

from eventsim.scene.disks import Disks
from eventsim.scene.domain import DOMAINS, Box, Channel, Domain, Open, Periodic
from eventsim.scene.files import apply_overrides, load_scene, scene_from_dict, scene_to_dict, scene_to_toml
from eventsim.scene.keywords import tell_keywords
from eventsim.scene.restitution import Restitution
from eventsim.scene.roughness import TangentialRestitution
from eventsim.scene.scene import Scene, touching_by_rounding
from eventsim.scene.walls import WALLS, Arc, Circle, Polygon, Polyline, Segment, Wall, feature_names, wall_names

__all__ = [
    "Arc",
    "Box",
    "Channel",
    "Circle",
    "Disks",
    "Domain",
    "Open",
    "Periodic",
    "Polygon",
    "Polyline",
    "Restitution",
    "Scene",
    "Segment",
    "Wall",
    "apply_overrides",
    "feature_names",
    "load_scene",
    "scene_from_dict",
    "scene_to_dict",
    "scene_to_toml",
    "touching_by_rounding",
    "wall_names",
]

for part in (Scene, Disks, Restitution, TangentialRestitution, *DOMAINS.values(), *WALLS.values()):
    tell_keywords(part)
