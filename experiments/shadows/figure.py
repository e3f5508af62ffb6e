#!/usr/bin/env python3
"""One page from the estimates of a case of run.sh: the image, what each model
cannot explain, and the light that each takes what it lacks for.

usage: figure.py OUT/CASE FIGURE.png [WITHOUT WITH]
  two of the effects that the case was solved with: none visibility
needs: python3, Pillow
"""
import pathlib
import sys

from PIL import Image, ImageDraw

case, target = pathlib.Path(sys.argv[1]), sys.argv[2]
without, having = sys.argv[3:5] if len(sys.argv) > 3 else ("none", "visibility")
# Caption, file, enlargement.
rows = [
    [("image", "input.png", 4),
     ("known light: " + without, f"reflectance-{without}/residual.png", 1),
     ("known light: " + having, f"reflectance-{having}/residual.png", 1)],
    [("known BRDF: " + without, f"illumination-{without}/illumination.png", 1),
     ("known BRDF: " + having, f"illumination-{having}/illumination.png", 1)],
]
margin, caption = 12, 30


def load(name, scale):
    picture = Image.open(case / name).convert("RGB")
    size = (scale * picture.width, scale * picture.height)
    return picture.resize(size, Image.NEAREST)


def label(text):
    small = Image.new("RGB", (7 * len(text), 13), "white")
    ImageDraw.Draw(small).text((0, 0), text, fill="black")
    return small.resize((2 * small.width, 2 * small.height))


drawn = [[(text, load(name, scale)) for text, name, scale in row]
         for row in rows]
width = max(sum(p.width + margin for _, p in row) for row in drawn) + margin
height = sum(max(p.height for _, p in row) + caption + margin
             for row in drawn) + margin
page = Image.new("RGB", (width, height), "white")
y = margin
for row in drawn:
    x = margin
    for text, picture in row:
        page.paste(label(text), (x, y))
        page.paste(picture, (x, y + caption))
        x += picture.width + margin
    y += max(p.height for _, p in row) + caption + margin
page.save(target)
