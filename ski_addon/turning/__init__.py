"""Lean and steer: the inverted pendulum on a steered support that all turning sports share [VP93]."""
