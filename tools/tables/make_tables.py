#!/usr/bin/env python3
"""Writes the tables of colour that the program holds: src/color/cie1931.csv, src/spectrum/d65.csv, src/spectrum/primaries.csv.

usage: pip install colour-science cvxpy numpy; python make_tables.py REPOSITORY

cie1931.csv    CIE 1931 2 degree colour matching functions, 1 nm, 360..830 nm (CIE 018:2019, table 6)
d65.csv        CIE standard illuminant D65, 5 nm, 300..830 nm, relative to 100 at 560 nm (CIE 15:2018)
primaries.csv  reflectances of the three sRGB primaries, 5 nm, 380..780 nm, after Mallett and Yuksel, "Spectral
               Primary Decomposition for Rendering with sRGB Reflectance" (EGSR 2019): the smoothest three curves
               within [0, 1] that add up to 1 and that have under D65 exactly the colours of the primaries. Solved anew here,
               so that "exactly" holds for the tables above and for linear interpolation between their rows. Each ends at
               1/3: beyond the visible an RGB colour says nothing, and the reflectance is the mean of the three.
"""
import sys
import colour
import cvxpy as cp
import numpy as np

top = sys.argv[1]
cmf = colour.MSDS_CMFS['CIE 1931 2 Degree Standard Observer'].copy().align(colour.SpectralShape(360, 830, 1))
nm, xyz = cmf.wavelengths, cmf.values
d65 = colour.SDS_ILLUMINANTS['D65'].copy().align(colour.SpectralShape(300, 830, 5))
np.savetxt(f'{top}/src/color/cie1931.csv', np.column_stack([nm, xyz]), fmt=['%d', '%.12g', '%.12g', '%.12g'], delimiter=',')
np.savetxt(f'{top}/src/spectrum/d65.csv', np.column_stack([d65.wavelengths, d65.values]), fmt=['%d', '%.6g'], delimiter=',')

# Integrals as the program does them: trapezium over the 1 nm rows, everything else linear between its own rows.
xyz = np.array([[float(f'{v:.12g}') for v in row] for row in xyz])
weight = np.ones(len(nm))
weight[[0, -1]] = 0.5
light = np.interp(nm, d65.wavelengths, [float(f'{v:.6g}') for v in d65.values])
integral = (xyz * (light * weight)[:, None]).T                        # 3 x 471
white = integral.sum(1)
integral /= white[1]
white /= white[1]
# Rec. 709 primaries, with the white of the D65 table itself.
p = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])
cols = np.array([[x / y, 1, (1 - x - y) / y] for x, y in p]).T
rgb_to_xyz = cols * np.linalg.solve(cols, white)
nodes = np.arange(380, 781, 5)
hat = np.array([np.interp(nm, nodes, np.eye(len(nodes))[i]) for i in range(len(nodes))]).T   # ends held
curve = cp.Variable((3, len(nodes)))
second = np.diff(np.eye(len(nodes)), axis=0)
rough = cp.sum_squares(curve @ second.T)
problem = cp.Problem(cp.Minimize(rough), [curve >= 0, curve <= 1, cp.sum(curve, axis=0) == 1, curve[:, 0] == 1 / 3, curve[:, -1] == 1 / 3,
                                          curve @ (integral @ hat).T == rgb_to_xyz.T])
problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-14, tol_gap_rel=1e-14, tol_feas=1e-14)
value = np.clip(curve.value, 0, 1)
print(problem.status, 'largest error of a primary:', abs(value @ (integral @ hat).T - rgb_to_xyz.T).max())
np.savetxt(f'{top}/src/spectrum/primaries.csv', np.column_stack([nodes, value.T]), fmt=['%d', '%.9f', '%.9f', '%.9f'], delimiter=',')
