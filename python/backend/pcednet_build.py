"""The build backend of pyproject.toml (PEP 517): runs CMake and packs what it installs.

Needs nothing but Python, CMake, a compiler and the libraries of scripts/packages.txt: no network.
The build folder is build/python, so that a second build is quick. Another one that has been
configured with PCEDNET_PYTHON_MODULE, such as build/release, is used if it is named:

    pip wheel . --config-settings=build-dir=build/release
    PCEDNET_BUILD_DIR=build/release pip install .
"""

import base64
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / dist_info()
    folder.mkdir()
    for name, text in metadata_files().items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    tags = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    name = f"pcednet-{version()}-{tags}-{tags}-{platform}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        package = install(config_settings or {}, pathlib.Path(prefix))
        files = {path.relative_to(package.parent).as_posix(): path.read_bytes()
                 for path in sorted(package.rglob("*")) if path.is_file()}
    wheel = (f"Wheel-Version: 1.0\nGenerator: pcednet_build\nRoot-Is-Purelib: false\n"
             f"Tag: {tags}-{tags}-{platform}\n")
    for file, text in {**metadata_files(), "WHEEL": wheel}.items():
        files[f"{dist_info()}/{file}"] = text.encode()
    files[f"{dist_info()}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    write_wheel(pathlib.Path(wheel_directory) / name, files)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Every file that git tracks."""
    base = f"pcednet-{version()}"
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, capture_output=True)
    with tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz") as archive:
        for name in filter(None, listed.stdout.decode().split("\0")):
            archive.add(ROOT / name, f"{base}/{name}")
        info = metadata_files()["METADATA"].encode()
        entry = tarfile.TarInfo(f"{base}/PKG-INFO")
        entry.size = len(info)
        archive.addfile(entry, io.BytesIO(info))
    return f"{base}.tar.gz"


def version():
    return re.search(r"project\(pcednet VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def dist_info():
    return f"pcednet-{version()}.dist-info"


def metadata_files():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version()}",
             f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {needed}" for needed in project["dependencies"]),
             "Description-Content-Type: text/markdown", "",
             (ROOT / project["readme"]).read_text(encoding="utf-8")]
    return {"METADATA": "\n".join(lines)}


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def install(settings, prefix):
    """Builds the module if needed and installs it; returns the folder of the package."""
    named = settings.get("build-dir") or os.environ.get("PCEDNET_BUILD_DIR")
    folder = ROOT / (named or "build/python")  # a full path stays as it is
    if not named:
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        run("cmake", "-S", ROOT, "-B", folder, *generator, "-DCMAKE_BUILD_TYPE=Release",
            "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=6", "-DPCEDNET_WEB=OFF",
            "-DPCEDNET_PYTHON_MODULE=ON", f"-DPython_EXECUTABLE={sys.executable}")
    run("cmake", "--build", folder, "--target", "_core", "--parallel", os.cpu_count() or 1)
    run("cmake", "--install", folder, "--component", "python", "--strip", "--prefix", prefix)
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    (found,) = prefix.rglob("_core.*.so")
    if found.name != f"_core{suffix}":
        raise SystemExit(f"{folder} builds {found.name} for another interpreter; "
                         f"{sys.executable} needs _core{suffix}")
    return found.parent


def write_wheel(path, files):
    record = ""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record += f"{name},sha256={digest},{len(content)}\n"
            add(archive, name, content)
        name = f"{dist_info()}/RECORD"
        add(archive, name, f"{record}{name},,\n".encode())


def add(archive, name, content):
    """The same bytes for the same content."""
    entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)
