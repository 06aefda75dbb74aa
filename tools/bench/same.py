#!/usr/bin/env python3
"""Whether two pictures are the same: same.py TERRELL.exr MITSUBA.npy prints by how much the means differ, the median difference of blocks of 16 x 16 pixels (terrell filters
textures over what a sample sees, Mitsuba does not, so single pixels differ where paint is fine) and the share of pixels within 1 %."""
import os
import sys

import mitsuba as mi
import numpy as np

from clock import HERE

sys.path.insert(0, os.path.join(HERE, "..", "mitsuba"))
from compare import difference, read_exr  # noqa: E402

mi.set_variant("scalar_rgb")
ours, theirs = read_exr(mi, sys.argv[1]), np.load(sys.argv[2])
height, width = (side // 16 * 16 for side in ours.shape[:2])


def blocks(picture):
    return picture[:height, :width].reshape(height // 16, 16, width // 16, 16, 3).mean((1, 3))


lit = theirs.max(-1) > 1e-3 * theirs.max()
lit_blocks = blocks(theirs).max(-1) > 1e-3 * theirs.max()
mean = abs(ours.mean() / theirs.mean() - 1)
print(mean, np.median(difference(blocks(ours), blocks(theirs))[lit_blocks]), (difference(ours, theirs)[lit] <= 0.01).mean())
