"""A bake as a strip of the nonlinear animation, and back: the track is this add-on's, all others are the user's."""

from __future__ import annotations

from typing import Any

import bpy

from .channels import MARK, is_ours_alone

TRACK = "Ski run"
"""Name of the track that a bake makes; a strip that was moved to another track is the user's."""


def take_strip(obj: bpy.types.Object) -> bpy.types.Action | None:
    """Take away the strip of an earlier bake of `obj`, and return its action if it may be written again."""
    data = obj.animation_data
    if data is None:
        return None
    for track in data.nla_tracks:
        if not track.name.startswith(TRACK) or track.lock:
            continue
        for strip in track.strips:
            action = strip.action
            if action is None or not action.get(MARK) or not is_ours_alone(action):
                continue
            track.strips.remove(strip)
            if not track.strips:
                data.nla_tracks.remove(track)
            return action
    return None


def add_strip(obj: bpy.types.Object, action: bpy.types.Action, slot: Any) -> str:
    """Put `action` on a track of its own above all others, frame for frame, and return a note for the user or "".

    An active action of the user stays where it is, and plays over the strip; that is what the note says.
    """
    data = obj.animation_data_create()
    if data.action == action:
        data.action = None
    track = data.nla_tracks.new()
    track.name = TRACK
    strip = track.strips.new(action.name, int(action.frame_start), action)
    strip.action_slot = slot
    strip.action_frame_start, strip.action_frame_end = action.frame_start, action.frame_end
    strip.frame_start, strip.frame_end = action.frame_start, action.frame_end
    strip.extrapolation = "HOLD_FORWARD"
    if data.action is None:
        return ""
    return f'the active action "{data.action.name}" plays over the strip: push it down or unlink it to see the run'
