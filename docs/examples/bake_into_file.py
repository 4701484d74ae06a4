"""Simulate a run and bake it into a .blend of your own: a new skier joins the scene, all else stays as it is.

    python bake_into_file.py shot.blend shot_with_skier.blend
    python bake_into_file.py shot.blend shot_with_skier.blend Hero    # on its armature Hero, which gets skis and poles

Needs Blender's module bpy in this Python. In Blender's own Python say
`blender --background --python bake_into_file.py -- shot.blend shot_with_skier.blend` and import it as
`from bl_ext.user_default.ski_addon import ski_addon`.
"""

from __future__ import annotations

import sys

try:
    import ski_addon
except ImportError:  # inside Blender the library is a part of the extension
    from bl_ext.user_default.ski_addon import ski_addon


def main(blend: str, target: str, armature: str | None = None) -> None:
    """Bake two turns of a giant slalom into `blend`, from frame 101 on, and save it as `target`."""
    changes = {"course.turn_count": 2, "bake.frame_start": 101, "bake.action": "Carving"}
    recording = ski_addon.simulate(ski_addon.load_run("medium_carving", changes))
    ski_addon.bake(recording, blend, armature, target)


if __name__ == "__main__":
    main(*(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]))
