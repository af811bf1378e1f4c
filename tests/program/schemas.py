# SPDX-License-Identifier: GPL-3.0-or-later
"""schemas.py WORK: the JSON Schemas of `hr2d schema`, of scenes and of results.

Results of all commands are what their schemas say, and are refused when a member is taken away,
renamed, or of another kind. The schema of scenes accepts what the reader accepts, also of scenes
that are damaged at random, and refuses the mistakes of tests/data/malformed that a schema can
express.

Environment: HR2D_PROGRAM, HR2D_SRCDIR, HR2D_TEST_MULTIPLIER, HR2D_TEST_SEED."""
import copy
import glob
import json
import os
import random
import re
import subprocess
import sys
import time

import jsonschema

PROGRAM = os.environ["HR2D_PROGRAM"]
TOP = os.environ["HR2D_SRCDIR"]
SCENES = os.path.join(TOP, "examples/scenes")
WORK = sys.argv[1]
failed = 0


def check(what, good):
    global failed
    if not good:
        failed += 1
        print("FAILED:", what)


def program(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True)


def schema(name):
    text = program("schema", name).stdout
    with open(os.path.join(TOP, "schemas", name + ".json"), encoding="utf-8") as stream:
        check(f"hr2d schema {name} prints the file", text == stream.read())
    found = json.loads(text)
    jsonschema.Draft202012Validator.check_schema(found)
    return jsonschema.Draft202012Validator(found)


# ---- the schemas themselves
names = [line.split()[0] for line in program("schema").stdout.splitlines()]
files = [os.path.basename(p)[:-5] for p in glob.glob(os.path.join(TOP, "schemas/*.json"))]
check("all schemas are listed", sorted(names) == sorted(files))
schemas = {name: schema(name) for name in names}
definitions = {}
for name, validator in schemas.items():
    for key, value in validator.schema["$defs"].items():
        if key == "provenance":
            value = copy.deepcopy(value)
            del value["properties"]["command"]
        check(f"{key} of {name} is that of others", definitions.setdefault(key, value) == value)

# ---- results
# Members that a result may lack; others that stand together are named by the first one.
OPTIONAL = set(
    "sunlight cut_off_estimate cut_off sunlight_cut_off assumes enclosed ranks law mirrors period"
    " temperature".split()
)


def places(value, path=()):
    """Each object and array in a value, the first three of each array, with its path."""
    if isinstance(value, dict):
        yield path, value
        for key, item in value.items():
            yield from places(item, path + (key,))
    elif isinstance(value, list):
        yield path, value
        for k, item in enumerate(value[:3]):
            yield from places(item, path + (k,))


def other_kind(value):
    """A value of a kind that never stands in the place of this one."""
    if value is None:
        return True
    return 1.5 if isinstance(value, str) else "x"


def damaged(document):
    """Copies with one member taken away, renamed, added or of another kind."""
    for path, value in places(document):
        if not isinstance(value, dict):
            continue
        for key in [*value, None]:
            for how in ["add"] if key is None else ["drop", "rename", "kind"]:
                copied = copy.deepcopy(document)
                at = copied
                for step in path:
                    at = at[step]
                if how == "add":
                    at["extra"] = 1
                elif how == "kind":
                    at[key] = other_kind(at[key])
                else:
                    item = at.pop(key)
                    if how == "rename":
                        at[key + "_"] = item
                    elif key in OPTIONAL:
                        continue
                yield f"{how} {'/'.join(map(str, (*path, key)))}", copied


def result(name, scene, *words):
    """Runs a command and checks its JSON; returns how many damaged copies were tried."""
    path = os.path.join(WORK, "x.json")
    if os.path.exists(path):
        os.remove(path)
    call = [name, scene, *words, "--quiet", "--json", path]
    run = program(*call)
    if not os.path.exists(path):
        check(f"{' '.join(call)}: {run.stderr}", False)
        return 0
    with open(path, encoding="utf-8") as stream:
        document = json.load(stream)
    error = jsonschema.exceptions.best_match(schemas[name].iter_errors(document))
    check(f"{' '.join(call)}: {error}", error is None)
    tried = 0
    # One item of each array is enough.
    small = json.loads(json.dumps(document))
    for _, value in list(places(small)):
        if isinstance(value, list) and value and isinstance(value[0], dict):
            del value[1:]
    if not schemas[name].is_valid(small):
        small = document
    for what, copied in damaged(small):
        tried += 1
        check(f"{name} {' '.join(words)}: {what} is accepted", not schemas[name].is_valid(copied))
    return tried


def scene_of(name):
    return os.path.join(SCENES, name)


HOT = os.path.join(WORK, "hot.geojson")
with open(HOT, "w", encoding="utf-8") as stream:
    json.dump(
        {
            "type": "FeatureCollection",
            "hr2d": {"background_temperature": 280, "sun": {"bearing": 20, "irradiance": 300}},
            "features": [
                {
                    "type": "Feature",
                    "properties": {"name": "floor", "temperature": 300, "emissivity": [[300, 0.5], [900, 0.7]]},
                    "geometry": {"type": "LineString", "coordinates": [[0, 0], [4, 0]]},
                },
                {
                    "type": "Feature",
                    "properties": {"name": "wall", "flux": 0, "emissivity": 0.8, "sides": "both"},
                    "geometry": {"type": "LineString", "coordinates": [[4, 0], [4, 1.5], [3, 2]]},
                },
            ],
        },
        stream,
    )
ROW = os.path.join(WORK, "row.geojson")
with open(ROW, "w", encoding="utf-8") as stream:
    json.dump(
        {
            "type": "FeatureCollection",
            "hr2d": {"period": [2, 0], "sun": {"direction": [9, -1], "irradiance": 1}},
            "features": [
                {
                    "type": "Feature",
                    "properties": {"name": "ground", "emission": 1, "reflectance": 0.3},
                    "geometry": {"type": "LineString", "coordinates": [[0, 0], [2, 0]]},
                },
                {
                    "type": "Feature",
                    "properties": {"name": "panel", "reflectance": 0.2, "sides": "both"},
                    "geometry": {"type": "LineString", "coordinates": [[0.5, 0.5], [1.2, 1]]},
                },
            ],
        },
        stream,
    )
ROOM, BOX = scene_of("lit-room.geojson"), scene_of("square-room.geojson")
tried = 0
for path in sorted(glob.glob(os.path.join(SCENES, "*"))):
    if path.endswith((".geojson", ".vs2")) and "occluders" not in path and "occ128" not in path:
        tried += result("info", path)
tried += result("info", HOT) + result("info", ROW)
tried += result("solve", ROOM, "--eps", "0.5", "--at", "floor:0.5", "--no-error")
tried += result("solve", BOX, "--eps", "0.5", "--order", "3", "--error")
tried += result("solve", BOX, "--target-error", "1e-3", "--importance", "0", "--at", "1:0.2")
tried += result("solve", BOX, "--target-error", "1e-12", "--time-budget", "0.01", "--norm", "sup")
tried += result("solve", BOX, "--eps", "1", "--enclose", "0.5", "--no-error")
tried += result("solve", HOT, "--eps", "1", "--at", "floor:0.5")
tried += result("solve", ROW, "--eps", "1", "--at", "ground:0.5", "--no-error")
tried += result("info", scene_of("greenhouse.geojson")) + result("info", scene_of("furnace-gas.geojson"))
tried += result("solve", scene_of("furnace-gas.geojson"), "--eps", "2")
tried += result("solve", scene_of("radiation-shields.geojson"), "--eps", "2", "--no-error")
tried += result("study", scene_of("par-far.geojson"), "--steps", "3", "--law")
tried += result("study", BOX, "--oracle", "l1", "--steps", "2")
tried += result("cost", BOX, "--max-seconds", "0.2", "--methods", "size,auto,factors,bf")
tried += result("cost", BOX, "--predict")
tried += result("factors", ROOM, "--group") + result("factors", ROW)
tried += result("field", HOT, "--grid", "3x2", "--normal", "1,2")
tried += result("field", ROOM, "--grid", "3x3", "--target-error", "0.1")
check(f"enough damage was tried, {tried}", tried > 2000)

# ---- scenes
scene = schemas["scene"]


def reader_takes(path):
    """Whether hr2d reads the file; what it refuses after that is no matter of a schema."""
    run = program("info", path, "--quiet")
    return run.returncode == 0


good = 0
FOUND = ["examples/scenes", "*/*/cli", "tests/data/strangers"]
for path in [path for folder in FOUND for path in glob.glob(os.path.join(TOP, folder, "*.geojson"))]:
    with open(path, encoding="utf-8") as stream:
        document = json.load(stream)
    good += 1
    error = jsonschema.exceptions.best_match(scene.iter_errors(document))
    check(f"{path}: {error}", error is None)
check(f"scenes were found, {good}", good >= 26)

blocks = 0
for path in glob.glob(os.path.join(TOP, "doc/**/*.md"), recursive=True):
    with open(path, encoding="utf-8") as stream:
        for block in re.findall(r"```json\n(.*?)```", stream.read(), re.S):
            if '"FeatureCollection"' in block:
                blocks += 1
                error = jsonschema.exceptions.best_match(scene.iter_errors(json.loads(block)))
                check(f"a scene of {path}: {error}", error is None)
check(f"scenes in pages were found, {blocks}", blocks >= 5)

# What needs more than a look at members one by one.
BEYOND = set("""
bands-differ duplicate-key escaped-nul hole-open huge-integer huge-number infinity lone-surrogate
not-a-number ring-cancels ring-figure-eight ring-flat ring-open ring-repeats
""".split())
refused, beyond = 0, []
for path in sorted(glob.glob(os.path.join(TOP, "tests/data/malformed/*.geojson"))):
    try:
        with open(path, encoding="utf-8") as stream:
            document = json.load(stream)
    except (ValueError, RecursionError):
        continue
    if scene.is_valid(document):
        beyond.append(os.path.basename(path)[:-8])
    else:
        refused += 1
check(f"what only the reader refuses is {beyond}", set(beyond) == BEYOND)
check(f"mistakes were refused, {refused}", refused >= 40)

FULL = {
    "type": "FeatureCollection",
    "hr2d": {
        "background": [0.1, 0.2],
        "sun": {"direction": [[0, -1], [1, -1]], "irradiance": [1, 2]},
        "sky": [[-90, 0, 1], [0, 90, [1, 2]]],
        "wavelengths": 4,
        "period": None,
        "medium": 0,
    },
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "room", "emission": [1, 2], "reflectance": 0.5, "faces": "in"},
            "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]},
        },
        {
            "type": "Feature",
            "properties": {"name": 7, "temperature": 300, "emissivity": [[300, 0.2], [900, 0.4]]},
            "geometry": {"type": "LineString", "coordinates": [[1, 1], [2, 1], [2, 2, 0]]},
        },
        {
            "type": "Feature",
            "properties": {"flux": -3, "emissivity": 0.5, "sides": "both"},
            "geometry": {
                "type": "GeometryCollection",
                "geometries": [
                    {"type": "MultiLineString", "coordinates": [[[3, 3], [4, 3]], [[5, 3], [6, 3]]]},
                    {"type": "MultiPolygon", "coordinates": [[[[3, 5], [4, 5], [4, 6], [3, 5]]]]},
                    {"type": "Point", "coordinates": [1, 1]},
                ],
            },
        },
    ],
}
VALUES = [None, True, 0, 1, -1, 0.5, 300, "both", "mirror", "Feature", "LineString", [], {}, [1], [0.5, 0.5],
          [[0, 0], [1, 1]], [[1, 0.5], [2, 0.5]], [[[0, 0], [1, 0], [1, 1], [0, 0]]], {"type": "Point"},
          {"type": "LineString", "coordinates": [[7, 7], [8, 8]]}]
WORDS = ["emission", "reflectance", "temperature", "flux", "emissivity", "sides", "faces", "name", "hr2d", "sun",
         "sky", "period", "medium", "background", "background_temperature", "wavelengths", "bearing", "direction",
         "irradiance", "geometry", "properties", "type", "coordinates", "geometries", "features", "other",
         "transmittance", "shield", "back", "absorption", "section", "weights"]


def harm(document, source):
    copied = copy.deepcopy(document)
    for _ in range(source.choice([1, 1, 2])):
        at = source.choice([value for _, value in places(copied)])
        value = copy.deepcopy(source.choice(VALUES))
        if isinstance(at, dict):
            key = source.choice(WORDS if source.random() < 0.4 or not at else list(at))
            if source.random() < 0.25:
                at.pop(key, None)
            else:
                at[key] = value
        elif at:
            if source.random() < 0.3:
                del at[source.randrange(len(at))]
            else:
                at[source.randrange(len(at))] = value
    return copied


seed = int(os.environ.get("HR2D_TEST_SEED", time.time()))
print(f"HR2D_TEST_SEED={seed}")
source = random.Random(seed)
count = max(200, int(3000 * float(os.environ.get("HR2D_TEST_MULTIPLIER", 1))))
read = told = wrong = 0
for _ in range(count):
    document = harm(FULL, source)
    path = os.path.join(WORK, "harmed.geojson")
    with open(path, "w", encoding="utf-8") as stream:
        json.dump(document, stream)
    valid, taken = scene.is_valid(document), reader_takes(path)
    read += taken
    wrong += not taken
    told += not taken and not valid
    check(f"the reader takes what the schema refuses: {json.dumps(document)}", valid or not taken)
print(f"{tried} damaged results; of {count} damaged scenes {read} are read, {told} of {wrong} refused by the schema, too")
check("some damaged scenes are read", read > count / 20)
check("the schema finds most mistakes", told > wrong / 2)
sys.exit(failed > 0)
