"""Writes assets/bright_stars.csv, the catalogue of the night sky, from bright_stars.txt: python3 tools/gallery/stars.py

The list's numbers are the Bright Star List for epoch 2016.5 of the Astronomical Almanac (U.S. Naval Observatory, public domain), to V = 4.0, places
rounded to a minute of arc. Temperatures are Ballesteros' for a black body of that B-V (EPL 97, 34008 (2012)):
T = 4600 K (1/(0.92 (B-V) + 1.7) + 1/(0.92 (B-V) + 0.62)).
"""
import os

here = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(here, "bright_stars.txt")) as file:
    rows = [line.split() for line in file if not line.startswith("#")]
with open(os.path.join(here, "../../assets/bright_stars.csv"), "w") as file:
    file.write("# The stars to magnitude 4.0: Astronomical Almanac, equinox 2016.5; temperatures from B-V (tools/gallery/stars.py)\n")
    file.write("right ascension,declination,V,kelvin\n")
    for _, ascension, declination, v, b_v in rows:
        degrees = 15 * (int(ascension[:2]) + float(ascension[2:]) / 60)
        tilt = (int(declination[1:3]) + int(declination[3:]) / 60) * (-1 if declination[0] == "-" else 1)
        blue = 0.92 * float(b_v)
        kelvin = 4600 * (1 / (blue + 1.7) + 1 / (blue + 0.62))
        file.write(f"{degrees:.3f},{tilt:.3f},{v},{kelvin:.0f}\n")
