#!/usr/bin/python3
"""Takes the figures that the examples have drawn (examples/*/run.sh) over into doc/figures, small enough to keep.

doc/figures.py [EXAMPLE ...]      all examples that have results, or those named
"""

import glob
import os
import sys

from PIL import Image, ImageChops, ImageOps

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
MARGIN = 12        # pixels of white around the figure


def keep(source, name, width):
    image = Image.open(source).convert("RGB")
    white = Image.new("RGB", image.size, "white")
    image = ImageOps.expand(image.crop(ImageChops.difference(image, white).getbbox()), MARGIN, "white")
    if image.width > width:
        image = image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)
    target = os.path.join(TOP, "doc", "figures", name)
    image.quantize(128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(target, optimize=True)
    print(f"{os.path.relpath(target, TOP)}: {image.width} x {image.height}, {os.path.getsize(target) / 1e3:.0f} kB")


def main():
    for source in sorted(glob.glob(os.path.join(TOP, "examples", "*", "results"))):
        example = os.path.basename(os.path.dirname(source))
        figure = os.path.join(source, example + ".png")
        if not os.path.exists(figure) or (sys.argv[1:] and example not in sys.argv[1:]):
            continue
        keep(figure, example + ".png", 900 if example == "gel" else 760)
        pictures = sorted(glob.glob(os.path.join(source, "pse", "picture.*.png")))
        if example == "gel" and pictures:
            keep(pictures[-1], "gel_picture.png", 480)    # the gel at the end, for the front page
        if os.path.exists(os.path.join(source, "yield.png")):
            keep(os.path.join(source, "yield.png"), "yield.png", 760)


if __name__ == "__main__":
    main()
