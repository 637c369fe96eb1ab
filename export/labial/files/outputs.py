"""Writes output files atomically: a file is complete, or the old one remains.

:func:`writing` is for one file, :func:`folder` for several that belong together. Output goes to a temporary file beside
the target, whose name begins with a dot and ends with ``.part``. It is synced to the disk before it is renamed to the
target, and removed after any failure: a full disk, an exception, Ctrl-C, SIGTERM. Only a killed process leaves one
behind, which the next one that writes the same target removes: each process holds a lock on its own, so that those of
processes that run are known. Errors name the target.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
import stat
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import IO, Any, Callable, Iterator, List, Mapping, Optional

from labial.errors import LabialError, PathLike

try:
    import fcntl
except ImportError:  # Windows, where nothing is removed
    fcntl = None  # type: ignore[assignment]

#: Names of temporary files and folders: a dot, the target's name, random letters, this suffix.
SUFFIX = ".part"
#: Bytes of a target's name in its temporary file's name, which must not become too long.
_NAMED = 200


def check_suffix(path: PathLike, *known: str) -> str:
    """How a file's name ends, one of `known` in small letters, such as ".html". Raises LabialError for another end;
    devices and pipes may have any, for which the first one counts."""
    suffix = Path(path).suffix.lower()
    if suffix in known:
        return suffix
    if os.fspath(path).startswith("/dev/") or (os.path.exists(path) and not os.path.isfile(path)):
        return known[0]
    raise LabialError(f"{os.fspath(path)}: the name of the output ends in {' or '.join(known)}")


@contextmanager
def writing(path: PathLike, encoding: Optional[str] = None) -> Iterator[IO[Any]]:
    """A file object for the content of `path`: text in `encoding` with LF line ends, or bytes without an encoding. The
    file replaces what is at `path` when the block ends, and never if the block raises. It keeps the permissions of the
    replaced file; links are followed. Devices, pipes and files of ``/dev/fd`` are written directly. Raises LabialError,
    which names `path`, if the file cannot be written."""
    with _named(path):
        target = _resolved(path)
    temporary = _part(target) if target is not None else ""  # named before it is created: a signal may come at any time
    try:
        with _named(path):
            if target is not None:
                _sweep(target)
            descriptor = _create(temporary, target) if target is not None else _direct(path)
            newline = None if encoding is None else "\n"
            file = os.fdopen(descriptor, "wb" if encoding is None else "w", encoding=encoding, newline=newline)
        with _unnamed_of(path), file:
            with _unnamed_of(path):
                yield file
                file.flush()
                if target is not None:
                    os.fsync(file.fileno())
        if target is not None:
            with _named(path):
                os.replace(temporary, target)
            _sync(os.path.dirname(target))
    finally:
        if target is not None:
            with suppress(OSError):
                os.unlink(temporary)


@contextmanager
def folder(path: PathLike, name: Optional[PathLike] = None) -> Iterator[Path]:
    """A temporary folder for the files of the folder `path`, which is created if missing. Errors of the folder itself
    name `name`, if it is given. A new folder appears with all of its files at once. A folder that exists stays, since
    it may be the current one, and its owner and permissions are the user's: the files are renamed into it one after the
    other when the block ends, each as :func:`writing` does; if that fails, the LabialError says which are new. No file
    is changed if the block raises."""
    target, shown = Path(path), path if name is None else name
    lock: Optional[int] = None
    with _named(shown):
        if target.exists() and not target.is_dir():
            raise LabialError(f"{path}: not a folder")
        made = [item for item in (target, *target.parents) if not item.exists()]
        place = Path(os.path.realpath(target))
        whole = not place.exists()
        staging = Path(_part(os.path.join(place if not whole else place.parent, place.name)))
    try:
        with _named(shown):
            for beside in (place, place.parent):
                _sweep(os.path.join(beside, place.name))
            place.mkdir(parents=True, exist_ok=True)
            lock = _create_folder(staging)
        try:
            yield staging
        except OSError as error:
            raise _translated(error, staging, target, shown) from None
        except LabialError as error:
            if str(staging) not in str(error):
                raise
            raise LabialError(str(error).replace(str(staging), str(target))) from None
        with _named(shown):
            files = sorted(item for item in staging.rglob("*") if not item.is_dir())
            for file in files:
                _sync(file)
            if whole:
                shutil.copymode(place, staging)
                if os.name == "nt":  # Windows does not rename onto an existing folder
                    os.rmdir(place)
                os.rename(staging, place)
            else:
                _move(files, staging, target)
        _sync(place.parent if whole else place)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        if lock is not None:
            os.close(lock)
        for item in made:
            with suppress(OSError):  # not empty after success
                item.rmdir()


def write_files(directory: PathLike, files: Mapping[str, str]) -> List[Path]:
    """Writes texts, by the names of their files, into a folder as :func:`folder` does; returns their paths."""
    with folder(directory) as made:
        for name, text in files.items():
            (made / name).write_bytes(text.encode())
    return [Path(directory) / name for name in files]


def check(path: Optional[PathLike], *suffixes: str) -> None:
    """Raises LabialError unless a file can be written at `path`, whose name ends in one of `suffixes` if there are any;
    call it before the work. None is standard output."""
    if path is None:
        return
    with _named(path):
        target = _resolved(path)
        if target is not None:
            temporary = _part(target)
            try:
                os.close(_create(temporary, target))
            finally:
                with suppress(FileNotFoundError):
                    os.unlink(temporary)
    if suffixes:
        check_suffix(path, *suffixes)


def check_folder(path: PathLike, name: Optional[PathLike] = None) -> None:
    """Raises LabialError unless :func:`folder` can write to `path`; call it before the work."""
    place = Path(path)
    with _named(path if name is None else name):
        if place.exists() and not place.is_dir():
            raise LabialError(f"{path}: not a folder")
        while not place.exists() and place != place.parent:
            place = place.parent
        staging = _part(os.path.join(place, os.path.basename(os.path.realpath(place))))
        try:
            os.mkdir(staging)
        finally:
            with suppress(FileNotFoundError):
                os.rmdir(staging)


# ---- Targets


def _followed(path: PathLike) -> str:
    """The absolute path of `path`; links are followed except those of /proc, which are open files (/dev/stdout)."""
    target = os.fsdecode(path)
    if not os.path.basename(target):
        raise LabialError(f"{target}: not the name of a file")
    for _ in range(40):  # as many as Linux follows
        parent = os.path.realpath(os.path.dirname(target) or ".")
        target = os.path.join(parent, os.path.basename(target))
        if target.startswith("/proc/") or not os.path.islink(target):
            break
        target = os.path.join(parent, os.readlink(target))
    return target


def _resolved(path: PathLike) -> Optional[str]:
    """The path to replace; None for a target that can only be written directly. Raises LabialError for a folder, and
    PermissionError for a read-only file."""
    target = _followed(path)
    if target.startswith("/proc/"):
        return None
    try:
        mode = os.stat(target).st_mode
    except FileNotFoundError:
        return target
    if stat.S_ISDIR(mode):
        raise LabialError(f"{os.fspath(path)}: a folder, not a file")
    if not stat.S_ISREG(mode):
        return None
    if not os.access(target, os.W_OK):
        raise PermissionError(13, "Permission denied")
    return target


def _part(target: str) -> str:
    """The path of a temporary file or folder beside `target`."""
    directory, name = os.path.split(target)
    cut = os.fsencode(name)[:_NAMED].decode("utf-8", "ignore")
    return os.path.join(directory, f".{cut}.{secrets.token_hex(4)}{SUFFIX}")


def _sweep(target: str) -> None:
    """Removes the temporary files and folders beside `target` whose processes are dead."""
    directory, ours = os.path.split(_part(target))
    begin = ours[: -len("00000000" + SUFFIX)]
    with suppress(OSError):
        pattern = re.compile(f"{re.escape(begin)}[0-9a-f]{{8}}{re.escape(SUFFIX)}")
        for path in [entry.path for entry in os.scandir(directory) if pattern.fullmatch(entry.name)]:
            with suppress(OSError):
                _remove_if_dead(path)


def _remove_if_dead(path: str) -> None:
    """Removes one that is this user's and that no process has locked."""
    if fcntl is None:
        return
    descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        status = os.fstat(descriptor)
        if status.st_uid != os.geteuid():
            return
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)  # an OSError where its process runs
        if not _is_at(descriptor, path):
            return
        if stat.S_ISDIR(status.st_mode):
            shutil.rmtree(path, ignore_errors=True)
        elif stat.S_ISREG(status.st_mode):
            os.unlink(path)
    finally:
        os.close(descriptor)


def _is_at(descriptor: int, path: str) -> bool:
    """Whether what is open is still what has this path."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False))
    except FileNotFoundError:
        return False


def _locked(descriptor: int, path: str) -> bool:
    """Locks what this process has just made, until it is closed; whether nobody removed it before it was locked. Some
    file systems have no locks: nothing is removed there."""
    if fcntl is not None:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
            return _is_at(descriptor, path)
    return True


def _create_folder(path: Path) -> Optional[int]:
    """Makes the temporary folder `path`; the descriptor that locks it, or None."""
    while True:
        path.mkdir()
        if fcntl is None:
            return None
        try:
            descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        except FileNotFoundError:  # another process took it for that of a dead one
            continue
        if _locked(descriptor, str(path)):
            return descriptor
        os.close(descriptor)


def _create(temporary: str, target: str) -> int:
    """The descriptor of a new file `temporary`, with the owner and permissions of `target`, or those of a new file."""
    while True:
        descriptor = os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_RDWR | getattr(os, "O_CLOEXEC", 0), 0o666)
        if _locked(descriptor, temporary):
            break
        os.close(descriptor)
    with suppress(OSError):
        found, own = os.stat(target), os.stat(temporary)
        if (found.st_uid, found.st_gid) != (own.st_uid, own.st_gid):
            with suppress(OSError):
                os.chown(temporary, found.st_uid, found.st_gid)
        os.chmod(temporary, stat.S_IMODE(found.st_mode))
    return descriptor


def _direct(path: PathLike) -> int:
    """A descriptor of a target that cannot be replaced; for an open file of this process, a duplicate descriptor."""
    directory, name = os.path.split(_followed(path))
    if directory == f"/proc/{os.getpid()}/fd" and name.isdigit():
        return os.dup(int(name))
    return os.open(path, os.O_WRONLY | os.O_TRUNC)


# ---- Renaming


def _move(files: List[Path], staging: Path, folder: Path) -> None:
    """Renames all files. After the first one, interruptions wait for the others."""
    ready: List[Callable[[], None]] = []
    names = [str(file.relative_to(staging)) for file in files]
    for file, name in zip(files, names):
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        resolved = _resolved(target)
        if resolved is None or os.path.dirname(resolved) != os.path.realpath(target.parent):
            ready.append(partial(_copied, file, target))
            continue
        with suppress(FileNotFoundError):
            shutil.copymode(resolved, file)
        ready.append(partial(_renamed, file, resolved))
    interruption: Optional[BaseException] = None
    at = 0
    while at < len(ready):
        try:
            ready[at]()
            at += 1
        except Exception as error:
            problem = (error.strerror if isinstance(error, OSError) else None) or str(error)
            done = f"{', '.join(names[:at])} new, {', '.join(names[at:])} as before" if at else "no file was changed"
            raise LabialError(f"{folder / names[at]}: {problem}; {done}") from None
        except BaseException as error:
            interruption = error
    if interruption is not None:
        raise interruption


def _renamed(file: Path, target: str) -> None:
    if file.exists():  # otherwise an interruption came right after the renaming
        os.replace(file, target)


def _copied(file: Path, target: Path) -> None:
    with writing(target) as out, open(file, "rb") as content:
        shutil.copyfileobj(content, out)


def _sync(path: PathLike) -> None:
    """Syncs a file or a folder to the disk; not every system supports that for folders."""
    try:
        descriptor = os.open(path, os.O_RDONLY if os.path.isdir(path) else os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    except OSError:
        if not os.path.isdir(path):
            raise


# ---- Errors


@contextmanager
def _named(path: PathLike) -> Iterator[None]:
    """Reports any system error within the block as one of `path`."""
    try:
        yield
    except OSError as error:
        raise _failure(path, error) from None


@contextmanager
def _unnamed_of(path: PathLike) -> Iterator[None]:
    """Reports system errors without a file name, within the block, as errors of writing `path`."""
    try:
        yield
    except OSError as error:
        if error.filename is not None or isinstance(error, BrokenPipeError):
            raise
        raise _failure(path, error) from None


def _failure(path: PathLike, error: OSError) -> LabialError:
    name, reason = os.fsdecode(path), error.strerror or error
    if isinstance(error, FileNotFoundError):
        reason = f"there is no folder {os.path.dirname(name) or '.'}"
    return LabialError(f"{name}: {reason}")


def _translated(error: OSError, staging: Path, target: Path, shown: PathLike) -> Exception:
    """Replaces the name of a temporary file in an error by its target; `shown` stands for the folder. An error of
    writing, which has no name, is one of the newest file."""
    if error.filename is None:
        files = [item for item in staging.rglob("*") if item.is_file()]
        name = str(max(files, key=lambda item: item.stat().st_mtime_ns)) if files else str(staging)
    else:
        name = os.fsdecode(error.filename)
    if not name.startswith(str(staging)):
        return error
    return _failure(target / name[len(str(staging)) + 1 :] if name != str(staging) else shown, error)
