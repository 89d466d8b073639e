#!/usr/bin/env python3
"""Writes the animations of this folder: one feature each, 100 x 100 units, 60 frames. Run it after changing it."""
import json
import os

HERE = os.path.dirname(os.path.abspath(__file__))


def ease(x1=0.33, y1=0.0, x2=0.67, y2=1.0):
    return {"i": {"x": [x2], "y": [y2]}, "o": {"x": [x1], "y": [y1]}}


def still(k):
    return {"a": 0, "k": k}


def keys(*pairs, easing=None, spatial=None):
    """(time, value) pairs as keyframes; spatial: a (to, ti) for each but the last."""
    out = []
    for i, (t, v) in enumerate(pairs):
        key = {"t": t, "s": v if isinstance(v, list) else [v]}
        if i + 1 < len(pairs):
            key.update(easing or ease(0, 0, 1, 1))
            if spatial:
                key["to"], key["ti"] = spatial[i]
        out.append(key)
    return {"a": 1, "k": out}


def hold(*pairs):
    return {"a": 1, "k": [{"t": t, "s": v if isinstance(v, list) else [v], "h": 1} for t, v in pairs]}


def tr(p=(0, 0), a=(0, 0), s=(100, 100), r=0, o=100, **more):
    def prop(v):
        return v if isinstance(v, dict) else still(list(v) if isinstance(v, (list, tuple)) else v)
    out = {"p": prop(p), "a": prop(a), "s": prop(s), "r": prop(r), "o": prop(o)}
    out.update(more)
    return out


def group(*items, **transform):
    return {"ty": "gr", "it": list(items) + [dict({"ty": "tr"}, **tr(**transform))]}  # some players want ty first


def rect(x, y, w, h, r=0, **more):
    return dict({"ty": "rc", "d": 1, "p": still([x, y]), "s": still([w, h]), "r": still(r)}, **more)


def ellipse(x, y, w, h, **more):
    return dict({"ty": "el", "d": 1, "p": still([x, y]), "s": still([w, h])}, **more)


def star(x, y, n=5, outer=40, inner=20, kind=1, rotation=0, inner_round=0, outer_round=0, d=1):
    return {"ty": "sr", "sy": kind, "d": d, "p": still([x, y]), "pt": still(n), "r": still(rotation),
            "ir": still(inner), "or": still(outer), "is": still(inner_round), "os": still(outer_round)}


def fill(*rgb, o=100, r=1):
    return {"ty": "fl", "c": still(list(rgb) + [1]), "o": o if isinstance(o, dict) else still(o), "r": r}


def stroke(*rgb, w=6, o=100, lc=1, lj=1, ml=4, d=None):
    out = {"ty": "st", "c": still(list(rgb) + [1]), "o": still(o), "w": w if isinstance(w, dict) else still(w),
           "lc": lc, "lj": lj, "ml": ml}
    if d:
        out["d"] = d
    return out


def bezier(v, i=None, o=None, c=True):
    zero = [[0, 0]] * len(v)
    return {"v": v, "i": i or zero, "o": o or zero, "c": c}


def path(v, i=None, o=None, c=True):
    return {"ty": "sh", "ks": still(bezier(v, i, o, c))}


CURVE = ([[10, 70], [50, 20], [90, 70]], [[0, 0], [-25, 0], [-10, -30]], [[10, -30], [25, 0], [0, 0]])
HEART = ([[50, 85], [15, 40], [50, 32], [85, 40]], [[20, -15], [0, 20], [0, -20], [0, -24]],
         [[-20, -15], [0, -24], [0, -20], [0, 20]])


def layer(ty, **more):
    out = {"ty": ty, "ip": 0, "op": 60, "st": 0, "sr": 1, "ks": tr(), "ao": 0, "bm": 0, "ddd": 0}
    out.update(more)
    return out


def shapes(*items, **more):
    return layer(4, shapes=list(items), **more)


def solid(color, w=100, h=100, **more):
    return layer(1, sc=color, sw=w, sh=h, **more)


def mask(shape, mode="a", inv=False, o=100, f=0, x=0):
    return {"mode": mode, "inv": inv, "pt": still(shape), "o": still(o), "f": still([f, f]), "x": still(x)}


def effect(kind, *values):
    """(type, value) pairs: 0 a number, 1 an angle, 2 a colour, 7 a choice."""
    return {"ty": kind, "nm": "", "en": 1, "ef": [{"ty": t, "nm": "", "v": still(v)} for t, v in values]}


def box(l, t, r, b):
    return bezier([[l, t], [r, t], [r, b], [l, b]])


# Some players want these before the others, and in this order.
FIRST = ["ddd", "ind", "ty", "nm", "parent", "td", "tt", "refId", "sr", "ks", "ao", "hasMask", "masksProperties"]


def ordered(layers):
    return [{k: l[k] for k in FIRST + [k for k in l if k not in FIRST] if k in l} for l in layers]


def animation(*layers, assets=None, **more):
    for i, l in enumerate(layers):
        l.setdefault("ind", i + 1)
    for asset in assets or []:
        if "layers" in asset:
            asset["layers"] = ordered(asset["layers"])
    layers = ordered(layers)
    out = {"v": "5.7.4", "fr": 30, "ip": 0, "op": 60, "w": 100, "h": 100, "nm": "", "ddd": 0,
           "assets": assets or [], "layers": list(layers)}
    out.update(more)
    return out


RED, GREEN, BLUE, GOLD = (0.9, 0.2, 0.15), (0.15, 0.7, 0.3), (0.15, 0.35, 0.85), (0.95, 0.75, 0.15)
BACK = lambda: solid("#e8e4dc")
STOPS = {"p": 3, "k": still([0, 0.9, 0.2, 0.1, 0.5, 0.95, 0.85, 0.2, 1, 0.1, 0.3, 0.8])}
ALPHA = {"p": 2, "k": still([0, 0.9, 0.2, 0.1, 1, 0.1, 0.3, 0.8, 0, 1, 0.5, 0.2, 1, 1])}


def linear(kind="gf", g=None, **more):
    return dict({"ty": kind, "t": 1, "g": g or STOPS, "s": still([10, 20]), "e": still([90, 80]), "o": still(100),
                 "r": 1}, **more)


def radial(h=0, a=0, g=None):
    return {"ty": "gf", "t": 2, "g": g or STOPS, "s": still([50, 50]), "e": still([90, 50]), "h": still(h),
            "a": still(a), "o": still(100), "r": 1}


def trim(s=0, e=100, o=0, m=1):
    prop = lambda v: v if isinstance(v, dict) else still(v)
    return {"ty": "tm", "s": prop(s), "e": prop(e), "o": prop(o), "m": m}


FILES = {
    # where things are
    "transform": animation(shapes(rect(0, 0, 40, 24), fill(*RED), ks=tr(
        p=keys((0, [20, 30]), (30, [70, 40]), (59, [50, 70])), a=(5, 3), s=keys((0, [100, 100]), (59, [160, 60])),
        r=keys((0, 0), (59, 200)), o=keys((0, 100), (59, 40))))),
    "easing": animation(shapes(ellipse(0, 0, 24, 24), fill(*BLUE), ks=tr(
        p=keys((0, [15, 50]), (59, [85, 50]), easing=ease(0.7, 0, 0.2, 1))))),
    "easing-dimensions": animation(shapes(rect(0, 0, 20, 20), fill(*GREEN), ks=tr(p=(50, 50), s={"a": 1, "k": [
        {"t": 0, "s": [60, 60, 100], "i": {"x": [0.2, 0.9, 1], "y": [1, 0.9, 1]},
         "o": {"x": [0.8, 0.1, 0], "y": [0, 0.1, 0]}}, {"t": 59, "s": [300, 200, 100]}]}))),
    "split-position": animation(shapes(rect(0, 0, 24, 24), fill(*RED), ks=tr(
        p={"s": True, "x": keys((0, 20), (59, 80), easing=ease(0.9, 0, 0.9, 0.4)), "y": keys((0, 25), (59, 75))}))),
    "spatial": animation(shapes(rect(0, 0, 26, 12), fill(*GOLD), ao=1, ks=tr(
        p=keys((0, [15, 75]), (30, [50, 25]), (59, [85, 75]),
               spatial=[([0, -35], [-20, 0]), ([20, 0], [0, -35])])))),
    "hold": animation(shapes(rect(0, 0, 30, 30), fill(*BLUE), ks=tr(
        p=hold((0, [25, 25]), (20, [75, 25]), (40, [75, 75])), r=hold((0, 0), (30, 45))))),
    "old-keyframes": animation(shapes(rect(0, 0, 30, 30), fill(*BLUE), ks=tr(p=(50, 50), r={"a": 1, "k": [
        dict({"t": 0, "s": [0], "e": [90]}, **ease()), dict({"t": 30, "s": [90], "e": [30]}, **ease()), {"t": 59}]}))),
    "parents": animation(
        layer(3, ks=tr(p=(50, 50), r=keys((0, 0), (59, 180)), s=(120, 80))),
        layer(3, parent=1, ks=tr(p=(20, 0), r=keys((0, 0), (59, -90)))),
        shapes(rect(0, 0, 20, 30), fill(*GREEN), parent=2, ks=tr(p=(5, 10), a=(2, 2), r=15))),
    "in-out": animation(
        shapes(ellipse(30, 50, 40, 40), fill(*RED), ip=10, op=35),
        shapes(ellipse(60, 50, 40, 40), fill(*GREEN), ip=20, op=50)),
    "precomp": animation(
        layer(0, refId="inner", w=60, h=60, st=5, ks=tr(p=(50, 50), a=(30, 30), r=keys((0, 0), (59, 60)))),
        BACK(),
        assets=[{"id": "inner", "layers": [
            shapes(ellipse(0, 0, 50, 50), fill(*BLUE), ind=1, ks=tr(p=keys((0, [0, 30]), (40, [60, 30])))),
            solid("#f0b040", 60, 60, ind=2)]}]),
    "time-remap": animation(
        layer(0, refId="inner", w=100, h=100, tm=keys((0, 0), (30, 1.5), (59, 0.25))),
        assets=[{"id": "inner", "layers": [shapes(rect(0, 0, 30, 30), fill(*RED), ind=1, ks=tr(
            p=keys((0, [20, 20]), (59, [80, 80])), r=keys((0, 0), (59, 90))))]}]),
    "stretch": animation(
        layer(0, refId="inner", w=100, h=100, sr=2, st=6),
        assets=[{"id": "inner", "layers": [shapes(rect(0, 0, 30, 30), fill(*RED), ind=1, ks=tr(
            p=keys((0, [20, 20]), (59, [80, 80]))))]}]),
    "skew": animation(shapes(group(rect(0, 0, 40, 30), fill(*BLUE), p=(50, 50), sk=keys((0, 0), (59, 30)),
                                   sa=still(20)))),
    # shapes
    "path": animation(shapes(path(*HEART), fill(*RED))),
    "path-morph": animation(shapes({"ty": "sh", "ks": {"a": 1, "k": [
        dict({"t": 0, "s": [bezier(*HEART)]}, **ease()),
        {"t": 59, "s": [bezier([[50, 90], [10, 50], [50, 10], [90, 50]], [[22, 0], [0, 22], [-22, 0], [0, -22]],
                               [[-22, 0], [0, -22], [22, 0], [0, 22]])]}]}}, fill(*RED))),
    "rectangle": animation(shapes(group(rect(30, 50, 40, 60, 8), fill(*RED)),
                                  group(rect(75, 50, 30, 70, 90), fill(*GREEN)))),
    "star": animation(shapes(group(star(30, 35, 5, 28, 12, rotation=10), fill(*GOLD)),
                             group(star(70, 65, 7, 26, 14, inner_round=40, outer_round=60), fill(*BLUE)))),
    "polygon": animation(shapes(group(star(30, 35, 6, 28, kind=2, rotation=15), fill(*GREEN)),
                                group(star(70, 65, 5, 26, kind=2, outer_round=80), fill(*RED)))),
    "even-odd": animation(shapes(star(50, 50, 5, 45, 8), ellipse(50, 50, 50, 50), fill(*BLUE, r=2))),
    "paint-order": animation(shapes(
        group(ellipse(40, 50, 50, 50), stroke(*BLUE, w=10), fill(*GOLD)),
        group(ellipse(65, 50, 50, 50), fill(*GREEN), stroke(*RED, w=10)))),
    "groups": animation(shapes(
        group(group(rect(0, 0, 30, 30), p=(20, 0), r=keys((0, 0), (59, 90))), rect(-20, 0, 20, 40),
              fill(*RED), stroke(*BLUE, w=4), p=(50, 50), s=(100, 140)))),
    "group-opacity": animation(BACK(), shapes(
        group(ellipse(40, 50, 50, 50), fill(*RED), o=50))),
    "stroke": animation(shapes(
        group(path([[15, 30], [50, 15], [85, 30]], c=False), stroke(*RED, w=12, lc=1, lj=1)),
        group(path([[15, 60], [50, 45], [85, 60]], c=False), stroke(*GREEN, w=12, lc=2, lj=2)),
        group(path([[15, 90], [50, 75], [85, 90]], c=False), stroke(*BLUE, w=12, lc=3, lj=3)))),
    "stroke-scaled": animation(shapes(group(ellipse(0, 0, 30, 30), stroke(*BLUE, w=6), p=(50, 50), s=(200, 200)))),
    "stroke-width": animation(shapes(path(*CURVE, c=False), stroke(*BLUE, w=keys((0, 0), (59, 20)), lc=2))),
    "dashes": animation(shapes(path(*CURVE, c=False), stroke(*RED, w=6, d=[
        {"n": "d", "v": still(12)}, {"n": "g", "v": still(6)}, {"n": "o", "v": keys((0, 0), (59, 36))}]))),
    "linear-gradient": animation(shapes(rect(50, 50, 80, 80), linear())),
    "radial-gradient": animation(shapes(ellipse(50, 50, 84, 84), radial())),
    "radial-highlight": animation(shapes(ellipse(50, 50, 84, 84), radial(60, 45))),
    "gradient-opacity": animation(BACK(), shapes(rect(50, 50, 80, 80), linear(g=ALPHA))),
    "gradient-stroke": animation(shapes(ellipse(50, 50, 64, 64), linear("gs", w=still(14), lc=1, lj=1, ml=4))),
    "gradient-animated": animation(shapes(rect(50, 50, 80, 80), {
        "ty": "gf", "t": 1, "o": still(100), "r": 1, "s": keys((0, [10, 50]), (59, [50, 10])),
        "e": keys((0, [90, 50]), (59, [50, 90])), "g": {"p": 2, "k": keys(
            (0, [0, 1, 0, 0, 1, 0, 0, 1]), (59, [0.3, 0, 1, 0, 1, 1, 1, 0]))}})),
    "trim": animation(shapes(path(*CURVE, c=False), trim(0, keys((0, 0), (59, 100))), stroke(*BLUE, w=8))),
    "trim-offset": animation(shapes(ellipse(50, 50, 60, 60), trim(10, 60, keys((0, 0), (59, 360))),
                                    stroke(*RED, w=8))),
    "trim-simultaneous": animation(shapes(ellipse(30, 50, 40, 40), rect(70, 50, 40, 40), trim(20, keys((0, 30), (59, 90)), 0, 1),
                                          stroke(*GREEN, w=6))),
    "trim-sequential": animation(shapes(ellipse(30, 50, 40, 40), rect(70, 50, 40, 40), trim(20, keys((0, 30), (59, 90)), 0, 2),
                                        stroke(*GREEN, w=6))),
    "trim-groups": animation(shapes(group(ellipse(30, 50, 40, 40), stroke(*RED, w=6)),
                                    group(rect(70, 50, 40, 40), stroke(*BLUE, w=6)), trim(0, 65))),
    "round-corners": animation(shapes(path([[15, 15], [85, 30], [70, 85], [30, 60]]), {"ty": "rd", "r": keys((0, 0), (59, 25))},
                                      fill(*BLUE))),
    "repeater": animation(shapes(group(rect(15, 20, 14, 14), fill(*RED), p=(0, 0)), {
        "ty": "rp", "c": still(4), "o": still(0), "m": 1,
        "tr": dict(tr(p=(18, 14), r=keys((0, 0), (59, 15)), s=(95, 95)), so=still(100), eo=still(100))})),
    "repeater-fades": animation(shapes(group(ellipse(25, 50, 30, 30), fill(*BLUE)), {
        "ty": "rp", "c": still(4), "o": still(0), "m": 1,
        "tr": dict(tr(p=(16, 0)), so=still(100), eo=still(20))})),
    "repeater-above": animation(shapes(group(ellipse(25, 50, 30, 30), stroke(*GOLD, w=4), fill(*BLUE)), {
        "ty": "rp", "c": still(4), "o": still(0), "m": 1,
        "tr": dict(tr(p=(16, 0)), so=still(100), eo=still(100))})),
    "repeater-below": animation(shapes(group(ellipse(25, 50, 30, 30), stroke(*GOLD, w=4), fill(*BLUE)), {
        "ty": "rp", "c": still(4), "o": still(0), "m": 2,
        "tr": dict(tr(p=(16, 0)), so=still(100), eo=still(100))})),
    "merge-exclude": animation(shapes(ellipse(40, 50, 50, 50), ellipse(62, 50, 50, 50), {"ty": "mm", "mm": 5}, fill(*RED))),
    "modifiers": animation(shapes(
        group(rect(25, 25, 36, 36), {"ty": "pb", "a": keys((0, -40), (59, 40))}, fill(*RED)),
        group(rect(75, 25, 36, 36), {"ty": "zz", "s": still(3), "r": still(4), "pt": still(1)}, fill(*GREEN)),
        group(rect(25, 75, 36, 36), {"ty": "tw", "a": keys((0, 0), (59, 90)), "c": still([25, 75])}, fill(*BLUE)),
        group(rect(75, 75, 36, 36), {"ty": "zz", "s": still(3), "r": still(4), "pt": still(2)}, fill(*GOLD)))),
    # layers as a whole
    "solid": animation(solid("#3060a0", 40, 60, ks=tr(p=(50, 50), a=(20, 30), r=30)), BACK()),
    "mask-add": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(bezier(*HEART)), mask(box(5, 5, 30, 30))]), BACK()),
    "mask-subtract": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(box(10, 10, 90, 90)), mask(bezier(*HEART), "s")]), BACK()),
    "mask-intersect": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(box(10, 10, 60, 90)), mask(bezier(*HEART), "i")]), BACK()),
    "mask-inverted": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(bezier(*HEART), inv=True)]), BACK()),
    "mask-opacity": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(bezier(*HEART), o=50)]), BACK()),
    "mask-feather": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(box(30, 30, 70, 70), f=20)]), BACK()),
    "mask-expansion": animation(solid("#3060a0", hasMask=True, masksProperties=[mask(box(40, 40, 60, 60), x=15)]), BACK()),
    "matte-alpha": animation(shapes(star(50, 50, 5, 45, 20), fill(*RED, o=70), td=1), shapes(rect(50, 50, 80, 60), linear(), tt=1), BACK()),
    "matte-alpha-inverted": animation(shapes(star(50, 50, 5, 45, 20), fill(*RED), td=1), shapes(rect(50, 50, 80, 60), linear(), tt=2), BACK()),
    "matte-luma": animation(shapes(rect(50, 50, 90, 90), linear(), td=1), shapes(rect(50, 50, 80, 60), fill(*BLUE), tt=3), BACK()),
    "matte-luma-inverted": animation(shapes(rect(50, 50, 90, 90), linear(), td=1), shapes(rect(50, 50, 80, 60), fill(*BLUE), tt=4), BACK()),
    "layer-opacity": animation(layer(0, refId="inner", w=100, h=100, ks=tr(o=50)), BACK(), assets=[{"id": "inner", "layers": [
        shapes(ellipse(40, 50, 50, 50), fill(*RED), ind=1), shapes(ellipse(60, 50, 50, 50), fill(*GREEN), ind=2)]}]),
    "blend": animation(*[shapes(rect(50, 8 + 12 * i, 80, 10), linear(), bm=m) for i, m in enumerate([1, 2, 3, 8, 10, 11, 15, 16])],
                       solid("#70a0c0")),
    "effects": animation(
        shapes(ellipse(0, 0, 24, 24), fill(*RED), ks=tr(p=(25, 25)), ef=[effect(29, (0, 15), (7, 1), (7, 0))]),
        shapes(ellipse(0, 0, 24, 24), fill(*RED), ks=tr(p=(70, 25)), ef=[effect(
            25, (2, [0, 0, 0, 1]), (0, 200), (1, 135), (0, 8), (0, 10))]),
        shapes(ellipse(0, 0, 24, 24), fill(*RED), ks=tr(p=(25, 75)), ef=[effect(
            21, (0, 0), (7, 0), (2, [0, 0.6, 0.2, 1]), (7, 0), (0, 0), (0, 0), (0, 1))]),
        shapes(rect(0, 0, 30, 30), linear(s=still([-15, 0]), e=still([15, 0])), ks=tr(p=(70, 75)), ef=[effect(
            20, (2, [0.2, 0, 0.4, 1]), (2, [1, 0.9, 0.5, 1]), (0, 100))]),
        BACK()),
    "text-glyphs": animation(
        layer(5, t={"d": {"k": [{"t": 0, "s": {"s": 40, "f": "Own", "t": "AB A\rBB", "j": 2, "tr": 50, "lh": 44, "ls": 0,
                                               "fc": [0.1, 0.2, 0.5], "sc": [0.9, 0.4, 0.1], "sw": 2, "of": True}}]}, "p": {}, "m": {"g": 1, "a": still([0, 0])}, "a": []},
              ks=tr(p=(50, 45))),
        fonts={"list": [{"fName": "Own", "fFamily": "Own", "fStyle": "Regular", "ascent": 75}]},
        chars=[{"ch": c, "size": 100, "style": "Regular", "w": w, "fFamily": "Own", "data": {"shapes": [group(s)]}}
               for c, w, s in (("A", 60, path([[5, 0], [30, -70], [55, 0]])), ("B", 50, path([[5, -70], [45, -70], [45, 0], [5, 0]], [[0, 0], [-20, -10], [0, 0], [0, 0]])))] +
              [{"ch": " ", "size": 100, "style": "Regular", "w": 25, "fFamily": "Own", "data": {}}]),
}

for name, content in FILES.items():
    with open(os.path.join(HERE, name + ".json"), "w", encoding="utf-8") as file:
        json.dump(content, file, separators=(",", ":"))
        file.write("\n")
