"""Build the extension's zips into dist/: one a platform from blender_manifest.toml, or one for this computer only.

    python .ci/build.py                        the release: the wheels the manifest lists, downloaded unmodified
    python .ci/build.py --development cp314    a zip for this platform and another Python, with the same libraries

Blender packs everything it finds in the source folder, so a clean copy of what ships is made in build/ first.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
WHEELS = ROOT / "wheels"
# The extension is this and the wheels, nothing else.
SHIPPED = ("__init__.py", "operators", "ski_addon", "presets", "LICENSE", "README.md", "CHANGELOG.md")
NOT_SHIPPED = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")


class BuildError(Exception):
    """Something that keeps a zip from being built, in one line."""


class Wheel(NamedTuple):
    """The parts of a wheel's file name."""

    name: str
    version: str
    python: str
    abi: str
    platform: str  # several tags, with dots between them

    @classmethod
    def parse(cls, file_name: str) -> Wheel:
        """Take `name-version-python-abi-platform.whl` apart."""
        parts = file_name.removesuffix(".whl").split("-")
        if not file_name.endswith(".whl") or len(parts) != len(cls._fields):
            raise BuildError(f"{file_name} is not the name of a wheel")
        return cls(*parts)

    @property
    def file_name(self) -> str:
        """The name of the file."""
        return "-".join(self) + ".whl"

    @property
    def python_version(self) -> str | None:
        """`3.11` for cp311, None for a wheel that fits every Python 3."""
        return f"{self.python[2]}.{self.python[3:]}" if self.python.startswith("cp") else None


def fits_platform(wheel: Wheel, platform: str) -> bool:
    """Whether the wheel belongs into the zip for a Blender platform such as `linux-x64`."""
    system, machine = {
        "linux-x64": ("manylinux", "x86_64"),
        "macos-arm64": ("macosx", "arm64"),
        "windows-x64": ("win", "amd64"),
    }[platform]
    tags = wheel.platform.split(".")
    return wheel.platform == "any" or any(tag.startswith(system) and tag.endswith(machine) for tag in tags)


def listed_wheels(manifest: dict) -> list[Wheel]:
    """The wheels a manifest asks for."""
    return [Wheel.parse(Path(path).name) for path in manifest["wheels"]]


def pip_download(folder: Path, requirements: Iterable[str], *options: str) -> None:
    """Download wheels of exactly these requirements into a folder, without what they depend on."""
    command = [sys.executable, "-m", "pip", "download", "-qq", "--disable-pip-version-check", "--no-deps"]
    command += ["--only-binary=:all:", *options, "--dest", str(folder), *requirements]
    if subprocess.run(command, check=False).returncode:
        raise BuildError(f"could not download {', '.join(requirements)} for {' '.join(options)}: is there a network?")


def fetch(wheels: Sequence[Wheel], folder: Path) -> None:
    """Download the wheels that are not in the folder yet; afterwards every one of them is there by its exact name."""
    folder.mkdir(parents=True, exist_ok=True)
    for wheel in wheels:
        if (folder / wheel.file_name).exists():
            continue
        options = ["--implementation", "cp", "--python-version", wheel.python_version or "3.11"]
        for tag in wheel.platform.split("."):
            options += ["--platform", tag]
        print(f"downloading {wheel.file_name}", flush=True)
        pip_download(folder, [f"{wheel.name}=={wheel.version}"], *options)
        if not (folder / wheel.file_name).exists():
            raise BuildError(f"{wheel.file_name} does not exist under that name any more: update blender_manifest.toml")


def development_wheels(manifest: dict, tag: str, folder: Path) -> list[Wheel]:
    """Download the manifest's libraries for this platform and the Python of a tag (`cp314`), and say which they are."""
    if not re.fullmatch(r"cp3\d+", tag):
        raise BuildError(f"{tag} is not a Python tag: give it as in cp314")
    versions = sorted({f"{wheel.name}=={wheel.version}" for wheel in listed_wheels(manifest)})
    present = map(Wheel.parse, os.listdir(folder) if folder.exists() else ())
    if sorted(f"{wheel.name}=={wheel.version}" for wheel in present) != versions:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        pip_download(folder, versions, "--implementation", "cp", "--python-version", f"3.{tag[3:]}")
    return [Wheel.parse(name) for name in sorted(os.listdir(folder))]


def stage(target: Path, manifest_text: str, wheels: Iterable[Wheel], wheel_folder: Path) -> None:
    """Make a folder that holds what ships: the sources, this manifest and these wheels."""
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    for name in SHIPPED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, target / name, ignore=NOT_SHIPPED)
        else:
            shutil.copy2(ROOT / name, target / name)
    (target / "blender_manifest.toml").write_text(manifest_text, encoding="utf-8")
    (target / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy2(wheel_folder / wheel.file_name, target / "wheels" / wheel.file_name)


def blender_tool() -> Path:
    """Blender's own extension tool: a script inside the bpy wheel that runs without Blender."""
    found = sorted(Path(sys.prefix).glob("[Ll]ib/**/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not found:
        raise BuildError("bpy is not in this environment, and its extension tool is needed: run `make env`")
    return found[-1]


def run_tool(*arguments: str | Path) -> None:
    """Run Blender's extension tool and insist that it succeeds."""
    command = [sys.executable, str(blender_tool()), *map(str, arguments)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise BuildError(f"blender_ext {arguments[0]} failed: {(done.stdout + done.stderr).strip()}")


def check_zip(path: Path, wheels: Iterable[Wheel]) -> None:
    """Insist that a zip holds the shipped files and exactly these wheels."""
    members = [name for name in zipfile.ZipFile(path).namelist() if not name.endswith("/")]
    inside = {Path(name).name for name in members if name.startswith("wheels/")}
    expected = {wheel.file_name for wheel in wheels}
    if inside != expected:
        raise BuildError(f"{path.name} has other wheels than it should: {', '.join(sorted(inside ^ expected))}")
    if any(name.startswith("numpy") for name in inside):
        raise BuildError(f"{path.name} carries numpy, which breaks Blender's own")
    stray = {name.split("/")[0] for name in members} - {*SHIPPED, "blender_manifest.toml", "wheels"}
    if stray:
        raise BuildError(f"{path.name} holds what does not ship: {', '.join(sorted(stray))}")


def build_release(manifest_text: str, target: Path) -> list[Path]:
    """Build and check one zip a platform; return them."""
    manifest = tomllib.loads(manifest_text)
    wheels = listed_wheels(manifest)
    fetch(wheels, WHEELS)
    source = ROOT / "build" / "extension"
    stage(source, manifest_text, wheels, WHEELS)
    run_tool("validate", source)
    run_tool("build", "--source-dir", source, "--output-dir", target, "--split-platforms")
    zips = []
    for platform in manifest["platforms"]:
        path = target / f"{manifest['id']}-{manifest['version']}-{platform.replace('-', '_')}.zip"
        run_tool("validate", path)
        check_zip(path, [wheel for wheel in wheels if fits_platform(wheel, platform)])
        zips.append(path)
    return zips


def development_manifest(manifest_text: str, wheels: Iterable[Wheel]) -> str:
    """The manifest with other wheels, and for no particular platform."""
    lines = "".join(f'  "./wheels/{wheel.file_name}",\n' for wheel in wheels)
    text = re.sub(r"^wheels = \[.*?^\]", f"wheels = [\n{lines}]", manifest_text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"^platforms = .*\n", "", text, flags=re.MULTILINE)


def build_development(manifest_text: str, target: Path, tag: str) -> list[Path]:
    """Build and check the zip for this platform and one Python; return it."""
    manifest = tomllib.loads(manifest_text)
    folder = WHEELS / tag
    wheels = development_wheels(manifest, tag, folder)
    source = ROOT / "build" / f"extension-{tag}"
    stage(source, development_manifest(manifest_text, wheels), wheels, folder)
    path = target / f"{manifest['id']}-{manifest['version']}-{tag}-development.zip"
    run_tool("build", "--source-dir", source, "--output-filepath", path)
    run_tool("validate", path)
    check_zip(path, wheels)
    return [path]


def main() -> int:
    """Build what the command line asks for and say what was made."""
    parser = argparse.ArgumentParser(description="Build the extension's zips into dist/.")
    parser.add_argument(
        "--development", metavar="TAG", help="only for this platform and this Python, for instance cp314"
    )
    arguments = parser.parse_args()
    manifest_text = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    target = ROOT / "dist"
    target.mkdir(exist_ok=True)
    try:
        if arguments.development:
            zips = build_development(manifest_text, target, arguments.development)
        else:
            zips = build_release(manifest_text, target)
    except BuildError as error:
        print(f"build: {error}", file=sys.stderr)
        return 1
    for path in zips:
        print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
