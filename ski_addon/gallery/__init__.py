"""The figures of the 1993 paper, drawn anew from the same questions: `python -m ski_addon gallery -o DIR`.

`PICTURES` is the table of them. A picture is made by a function that draws into an empty matplotlib figure; it and its
neighbours of one kind share a module, which is loaded when the picture is drawn.
"""

from __future__ import annotations

from .table import PICTURES, Picture, draw_picture, find_pictures, save_picture

__all__ = ["PICTURES", "Picture", "draw_picture", "find_pictures", "save_picture"]
