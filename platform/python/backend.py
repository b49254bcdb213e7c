"""Builds the wheel of the package (PEP 517): the core inside, and picture files beside it whose
libraries the system has: PNG, JPEG, depth in XMP.

    pip install ./platform/python
    pip wheel ./platform/python --config-settings setup-args=-Dheic=enabled    (options of meson)
"""
import base64
import hashlib
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sysconfig
import tempfile
import tomllib
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
#: Features that are taken when their libraries are there.
FILES = ('jpeg', 'png', 'xmp')
#: Formats that are modules, which are loaded from a folder of the system and not out of a wheel.
MODULES = ('tiff', 'openexr', 'webp', 'jxl', 'raw', 'npz')
KERNELS = ('x86_64', 'amd64', 'aarch64', 'arm64', 'armv7l', 'armv8l')


def version():
    return re.search(r"version: '([^']+)'", (TOP / 'meson.build').read_text()).group(1)


def metadata():
    project = tomllib.loads((HERE / 'pyproject.toml').read_text())['project']
    lines = ['Metadata-Version: 2.1', f'Name: {project["name"]}', f'Version: {version()}',
             f'Summary: {project["description"]}', f'License: {project["license"]["text"]}',
             f'Requires-Python: {project["requires-python"]}',
             *(f'Requires-Dist: {name}' for name in project['dependencies'])]
    return project['name'], '\n'.join(lines) + '\n'


def options(arguments):
    """All options of meson, by those that were given; meson takes the last of each."""
    for name in MODULES:
        if {f'-D{name}=enabled', f'-D{name}=auto'} & set(arguments):
            raise ValueError(f'-D{name}: this format is a module, which a wheel does not hold; '
                             'build librefocus with meson and use its Python package')
    features = re.findall(r"^option\('(\w+)', type: 'feature'",
                          (TOP / 'meson_options.txt').read_text(), re.M)
    kernels = 'enabled' if platform.machine().lower() in KERNELS else 'disabled'
    return ['--prefix=/usr', '-Dbuildtype=release',
            *(f'-D{name}=disabled' for name in features if name not in FILES),
            f'-Dsimd={kernels}', '-Dpython=enabled', '-Dwheel=true',
            '-Dexamples=false', *arguments]


def compile_package(folder, arguments):
    """The installed package, from a build in a folder."""
    build = folder / 'build'
    for command in (
            ['setup', build, TOP, *options(arguments)],
            ['compile', '-C', build, 'python-package'],
            ['install', '-C', build, '--no-rebuild', '--tags', 'python-runtime', '--destdir',
             folder / 'installed']):
        subprocess.run(['meson', *command], check=True)
    return next((folder / 'installed').rglob('refocus/__init__.py')).parent


def write_wheel(path, files):
    """A zip file with a list of what is in it: {name: bytes}."""
    record = next(name for name in files if name.endswith('/RECORD'))
    lines = []
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            if name == record:
                lines.append(f'{name},,\n')
                content = ''.join(lines).encode()
            else:
                digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=')
                lines.append(f'{name},sha256={digest.decode()},{len(content)}\n')
            # No times of files: the same source makes the same wheel.
            entry = zipfile.ZipInfo(name)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)


def about_files(tag):
    """What a wheel says about itself."""
    name, about = metadata()
    folder = f'{name}-{version()}.dist-info'
    return {f'{folder}/METADATA': about.encode(),
            f'{folder}/LICENSE': (TOP / 'LICENSE').read_bytes(),
            f'{folder}/WHEEL': (f'Wheel-Version: 1.0\nGenerator: librefocus\n'
                                f'Root-Is-Purelib: false\nTag: {tag}\n').encode(),
            f'{folder}/RECORD': b''}


def tag_of_wheel():
    return 'cp311-abi3-' + re.sub(r'[-.]', '_', sysconfig.get_platform())


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    for name, content in about_files(tag_of_wheel()).items():
        path = pathlib.Path(metadata_directory, name)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    return path.parent.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    arguments = (config_settings or {}).get('setup-args', '')
    arguments = shlex.split(arguments if isinstance(arguments, str) else ' '.join(arguments))
    tag = tag_of_wheel()
    with tempfile.TemporaryDirectory() as folder:
        package = compile_package(pathlib.Path(folder), arguments)
        files = {f'refocus/{path.name}': path.read_bytes() for path in sorted(package.iterdir())
                 if path.is_file()}
    wheel = f'{metadata()[0]}-{version()}-{tag}.whl'
    write_wheel(os.path.join(wheel_directory, wheel), files | about_files(tag))
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError('The source is the repository: pip install ./platform/python, or '
                              'git+URL#subdirectory=platform/python')
