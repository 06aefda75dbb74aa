"""The street's red car by itself (car.glb), at rest on y = 0: it faces +x, its middle is the origin."""
import os

import kit
import street
import street_parts as parts


def main():
    folder = kit.output_folder()
    kit.empty_scene()
    kit.place("Car", parts.car(street.materials(), "PaintRed", "Car"))
    kit.export_glb(os.path.join(folder, "car.glb"))


if __name__ == "__main__":
    main()
