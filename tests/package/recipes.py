# SPDX-License-Identifier: GPL-3.0-or-later
"""recipes.py SOURCES RECIPES: what the recipes of packaging/make.sh say beside what configure.ac,
packaging/homepage and the tree say, a line for each difference. Exit status 1 if there is one.

YAML is parsed if this Python has the module yaml."""
import json
import re
import sys
from pathlib import Path

sources, recipes = Path(sys.argv[1]), Path(sys.argv[2])
faults = []
configure = (sources / "configure.ac").read_text()
version = ".".join(re.search(rf"hr2d_{part}\], \[(\d+)", configure)[1] for part in ("major", "minor", "patch"))
homepage = (sources / "packaging/homepage").read_text().strip()

# name: least version
needed = {}
for macro in re.findall(r"PKG_CHECK_MODULES\(\[(?:GSL|JANSSON|CAIRO)\], \[([^]]*)\]", configure):
    for name, least in re.findall(r"([\w-]+)(?: >= ([\d.]+))?", macro):
        needed[name.split("-")[0]] = least or needed.get(name.split("-")[0])

# What AC_ARG_ENABLE and AC_ARG_WITH know, and what libtool and automake add.
options = {"static", "shared", "dependency-tracking", "silent-rules"}
options |= set(re.findall(r"AC_ARG_(?:ENABLE|WITH)\(\[([\w-]+)\]", configure))
options |= set(re.findall(r"AC_ARG_ENABLE\(\[([\w-]+)\]", "".join(
    path.read_text() for path in (sources / "m4").glob("hr2d*.m4"))))


def fault(path, what):
    faults.append(f"{path.relative_to(recipes) if recipes in path.parents else path}: {what}")


def compare(path, what, found, expected):
    if found != expected:
        fault(path, f"{what} is {found}, not {expected}")


def one(path, pattern):
    """The group of the pattern, where it is the same each time."""
    found = set(re.findall(pattern, path.read_text(), re.M))
    return found.pop() if len(found) == 1 else ", ".join(sorted(found)) or "not there"


def libraries(path, found):
    """(name, least version or nothing) of those that the recipe asks for."""
    have = {}
    for name, least in found:
        have[name.split("-")[0]] = least or have.get(name.split("-")[0], "")
    for name, least in needed.items():
        if name not in have:
            fault(path, f"{name} is no dependency")
        elif have[name] and have[name] != least:
            fault(path, f"{name} >= {have[name]}, and configure.ac has {least}")


def yaml_of(path):
    try:
        import yaml
    except ImportError:
        return None
    return yaml.safe_load(path.read_text())


# Each has its version, licence, home page and libraries.
path = recipes / "conda/recipe.yaml"
compare(path, "the version", one(path, r'^  version: "(.*)"'), version)
compare(path, "the licence", one(path, r"^  license: (.*)"), "GPL-3.0-or-later")
compare(path, "the home page", one(path, r"^  homepage: (.*)"), homepage)
libraries(path, re.findall(r"^    - (cairo|gsl|jansson)(?: >=([\d.]+))?$", path.read_text(), re.M))
tree = yaml_of(path)
if tree:
    compare(path, "version parsed", tree["context"]["version"], version)

path = recipes / "vcpkg/vcpkg.json"
tree = json.loads(path.read_text())
compare(path, "the version", tree["version"], version)
compare(path, "the licence", tree["license"], "GPL-3.0-or-later")
compare(path, "the home page", tree["homepage"], homepage)
libraries(path, [(name, "") for name in tree["dependencies"] + tree["features"]["tools"]["dependencies"]])
path = recipes / "vcpkg/portfile.cmake"
compare(path, "the checksum's length", len(one(path, r"SHA512 (\w+)")), 128)

path = recipes / "spack/package.py"
compile(path.read_text(), str(path), "exec")
compare(path, "the version", one(path, r'version\("([^"]*)"'), version)
compare(path, "the licence", one(path, r'license\("(.*)"\)'), "GPL-3.0-or-later")
compare(path, "the home page", one(path, r'homepage = "(.*)"'), homepage)
libraries(path, re.findall(r'depends_on\("(gsl|jansson|cairo)@([\d.]+):', path.read_text()))

path = recipes / "homebrew/libhr2d.rb"
compare(path, "the version", one(path, r'url ".*/libhr2d-(.*)\.tar\.gz"'), version)
compare(path, "the licence", one(path, r'license "(.*)"'), "GPL-3.0-or-later")
compare(path, "the home page", one(path, r'homepage "(.*)"'), homepage)
libraries(path, re.findall(r'depends_on "(gsl|jansson|cairo)"()', path.read_text()))

path = recipes / "nix/default.nix"
compare(path, "the version", one(path, r'version = "(.*)"'), version)
compare(path, "the licence", one(path, r"license = lib\.licenses\.(.*);"), "gpl3Plus")
compare(path, "the home page", one(path, r'homepage = "(.*)"'), homepage)
libraries(path, [(name, "") for name in one(path, r"buildInputs = \[ (cairo.*) \]").split()])

path = recipes / "rpm/libhr2d.spec"
compare(path, "the version", one(path, r"^Version: +(.*)"), version)
compare(path, "the licence", one(path, r"^License: +(.*)"), "GPL-3.0-or-later")
compare(path, "the home page", one(path, r"^URL: +(.*)"), homepage)
libraries(path, re.findall(r"^BuildRequires: +pkgconfig\((gsl|jansson|cairo-\w+)\)(?: >= ([\d.]+))?", path.read_text(), re.M))

path = recipes / "oss-fuzz/project.yaml"
compare(path, "the home page", one(path, r'^homepage: "(.*)"'), homepage)
yaml_of(path)
path = recipes / "oss-fuzz/build.sh"
harnesses = set(one(path, r"^for harness in (.*); do").split())
compare(path, "the list of fuzzers", harnesses, {name.stem[5:] for name in (sources / "fuzz").glob("fuzz-*.c")})
for name in harnesses:
    if not any((sources / "fuzz/corpus" / name).glob("*")):
        fault(path, f"there is no fuzz/corpus/{name}")
libraries(recipes / "oss-fuzz/Dockerfile", [("cairo", "")] + re.findall(
    r"\blib(gsl|jansson)-dev()", (recipes / "oss-fuzz/Dockerfile").read_text()))

# All have the same source, options that configure knows, and files that the tree has.
for path in sorted(path for path in recipes.rglob("*") if path.is_file()):
    text = path.read_text()
    for name in re.findall(r"@[A-Z0-9]+@", text):
        fault(path, f"{name} is left")
    for name in re.findall(r"--(?:enable|disable|with|without)-([a-z0-9-]+)", text):
        if name not in options:
            fault(path, f"configure has no option {name}")
    # Below $OUT and in what is installed other names stand.
    for name in re.findall(r"(?<![\w$./{}-])(?:\.\./)?((?:tests|fuzz|doc|examples|include)/[\w./-]*\w)", text):
        if name != "fuzz/fuzz" and not (sources / name).exists():  # fuzz/fuzz-$harness
            fault(path, f"there is no {name}")
    for name in re.findall(r"\b(COPYING|NEWS|README\.md|SECURITY\.md)\b", text):
        if not (sources / name).exists():
            fault(path, f"there is no {name}")
    for digest in re.findall(r"\b[0-9a-f]{32,}\b", text):
        if len(digest) not in (64, 128):
            fault(path, f"a checksum of {len(digest)} digits")

# Debian: the folder is not in the tarball.
path = sources / "debian/control"
if path.exists():
    compare(path, "the home page", one(path, r"^Homepage: (.*)"), homepage)
    libraries(path, re.findall(r"^ lib(gsl|jansson|cairo)2?-dev(),$", path.read_text().split("\nPackage:")[0], re.M))
    path = sources / "debian/watch"
    compare(path, "the home page", one(path, r"^(https://\S*)/ "), homepage)
    path = sources / "debian/upstream/metadata"
    compare(path, "the home page", one(path, r"^Repository: (.*)"), homepage)
    compare(path, "the paper", one(path, r"DOI: (.*)"), one(sources / "CITATION.cff", r'doi: "(.*)"'))
    yaml_of(path)

print("\n".join(faults), end="\n" if faults else "")
sys.exit(bool(faults))
