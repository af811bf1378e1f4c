# SPDX-License-Identifier: GPL-3.0-or-later
"""sbom.py SOURCES [TARBALL]: a bill of materials, SPDX 2.3 as JSON, on standard output.

libhr2d with the licences of .reuse/dep5, and what it is linked with: libraries and least versions of
configure.ac, versions of pkg-config. The same tree and libraries give the same bytes: the date is
SOURCE_DATE_EPOCH, or that of the release in CITATION.cff.

Environment: PKG_CONFIG, HOMEPAGE, SOURCE_DATE_EPOCH."""
import datetime
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

# Of configure.ac: the name of PKG_CHECK_MODULES, its licence, its home, and what it is to libhr2d.
LIBRARIES = {
    "GSL": ("gsl", "GPL-3.0-or-later", "https://www.gnu.org/software/gsl/", "DEPENDENCY_OF"),
    "JANSSON": ("jansson", "MIT", "https://github.com/akheron/jansson", "DEPENDENCY_OF"),
    "CAIRO": ("cairo", "LGPL-2.1-only OR MPL-1.1", "https://www.cairographics.org/", "OPTIONAL_DEPENDENCY_OF"),
}


def digest(path, name):
    return {"algorithm": name, "checksumValue": hashlib.new(name.lower(), path.read_bytes()).hexdigest()}


def modversion(name):
    """The version that pkg-config finds, or None."""
    try:
        found = subprocess.run([os.environ.get("PKG_CONFIG") or "pkg-config", "--modversion", name],
                               capture_output=True, text=True, check=False)
    except OSError:
        return None
    return found.stdout.strip() or None


def stanzas(dep5):
    """(files, copyright, licence) of each stanza."""
    for text in dep5.read_text().split("\n\n"):
        fields = {}
        for line in text.splitlines():
            if re.match(r"[A-Z]\S*:", line):
                key, value = line.split(":", 1)
                fields[key] = value.strip()
            else:
                fields[key] = (fields[key] + "\n" + line.strip()).strip()
        if "Files" in fields:
            yield fields["Files"], fields["Copyright"], fields["License"]


def created(citation):
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    if epoch:
        return datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    return re.search(r"^date-released: (\S+)", citation.read_text(), re.M)[1] + "T00:00:00Z"


def package(name, version, licence, copyright_text, **others):
    found = {"SPDXID": f"SPDXRef-{name}", "name": name, "filesAnalyzed": False, "licenseConcluded": licence,
             "licenseDeclared": licence, "copyrightText": copyright_text, **others}
    if version:
        found["versionInfo"] = version
    return found


def bill(sources, tarball):
    configure = (sources / "configure.ac").read_text()
    version = ".".join(re.search(rf"hr2d_{part}\], \[(\d+)", configure)[1] for part in ("major", "minor", "patch"))
    homepage = os.environ.get("HOMEPAGE") or (sources / "packaging/homepage").read_text().strip()
    (_, holders, licence), *others = stanzas(sources / ".reuse/dep5")
    packages = [package("libhr2d", version, licence, f"Copyright {holders}", homepage=homepage,
                        downloadLocation="NOASSERTION", supplier="Organization: libhr2d contributors",
                        primaryPackagePurpose="LIBRARY")]
    if tarball:
        packages[0].update(packageFileName=tarball.name, checksums=[digest(tarball, "SHA256")])
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-libhr2d")]
    for macro, (name, its_licence, home, relation) in LIBRARIES.items():
        modules = re.search(rf"PKG_CHECK_MODULES\(\[{macro}\], \[([^]]*)\]", configure)[1]
        module, least = re.search(r"(\S+) >= (\S+)", modules).groups()
        found = modversion(module)
        packages.append(package(
            name, found, its_licence, "NOASSERTION", homepage=home, downloadLocation="NOASSERTION",
            comment=f"libhr2d needs {least} or later",
            externalRefs=[{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                           "referenceLocator": f"pkg:generic/{name}" + (f"@{found}" if found else "")}]))
        relations.append((f"SPDXRef-{name}", relation, "SPDXRef-libhr2d"))
    files = []
    for patterns, holders, its_licence in others:
        for path in sorted(path for pattern in patterns.split() for path in sources.glob(pattern)):
            name = path.relative_to(sources).as_posix()
            files.append({"SPDXID": "SPDXRef-" + re.sub(r"[^\w.]", "-", name).replace("_", "-"), "fileName": f"./{name}",
                          "checksums": [digest(path, "SHA1")], "licenseConcluded": its_licence,
                          "licenseInfoInFiles": [its_licence], "copyrightText": holders})
            relations.append(("SPDXRef-libhr2d", "CONTAINS", files[-1]["SPDXID"]))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"libhr2d-{version}",
        "creationInfo": {"created": created(sources / "CITATION.cff"), "creators": ["Organization: libhr2d contributors"]},
        "packages": packages, "files": files,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                          for a, kind, b in relations],
    }
    # Of its own for each content.
    name = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()[:32]
    document["documentNamespace"] = f"{homepage}/spdx/libhr2d-{version}-{name}"
    return document


if __name__ == "__main__":
    given = [Path(name) for name in sys.argv[1:]]
    json.dump(bill(given[0], given[1] if len(given) > 1 else None), sys.stdout, indent=2, ensure_ascii=False)
    print()
