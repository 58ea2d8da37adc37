# SPDX-License-Identifier: Apache-2.0
"""disk_test.py PROGRAM PLUGINS REPETITIONS: studies of so many runs of each pipeline on a disk that fills up
and in a folder that is read-only: the program says so and ends with exit code 3, the store is sound, and with
space again the same call goes on to what an undisturbed study gives.

The disks are small tmpfs in a mount name space of the test's own; where the system refuses one the
test is skipped."""
import os
import subprocess
import sys
import tempfile

from study_kit import Study, runs

PROGRAM, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:3])
SKIPPED = 77
PIPELINES = {"straight": "{plan: told}", "long": "{plan: rogue, with: {does: thousands}}"}
MORE = "repetitions: %s\n" % sys.argv[3]  # 3 or more: some runs are stored before the disk is full


def mount(folder, options):
    os.makedirs(folder, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], check=True)


def remount(folder, options):
    subprocess.run(["mount", "-o", "remount," + options, folder], check=True)


def fill(folder, leave):
    """Writes until so many bytes are left."""
    free = os.statvfs(folder).f_bavail * os.statvfs(folder).f_frsize
    with open(os.path.join(folder, "ballast"), "wb") as stream:
        stream.write(bytes(free - leave))


def expect(said, *parts):
    for part in parts:
        assert part in said, "'%s' is not in: %s" % (part, said)
    assert "internal" not in said and "Traceback" not in said, said


def sound_part(store, expected):
    """How many runs are stored; each is as expected."""
    found = runs(store) if os.path.exists(store) else []
    of = {row[4]: row for row in expected}
    assert all(row == of[row[4]] for row in found), "a stored run is not as it should be"
    return len(found)


def disk_of_the_store_fills_up(study, folder, expected):
    disk = os.path.join(folder, "small")
    store = os.path.join(disk, "study.db")
    for leave_kb, jobs in ((0, 2), (64, 2), (200, 1), (2000, 2)):  # one after the other: some are stored
        mount(disk, "size=40m")
        fill(disk, leave_kb << 10)
        process = study.start(store, "--jobs", jobs)
        said = process.communicate(timeout=600)[0].decode(errors="replace")
        expect(said, disk)
        there = sound_part(store, expected)
        if process.returncode == 0:  # what it stored made room for what it tried again
            assert there == len(expected) and leave_kb > 64, said
        else:
            assert process.returncode == 3 and there < len(expected), said
            assert "full" in said or "No space left" in said, said
        os.remove(os.path.join(disk, "ballast"))
        study.run(store, "--jobs", 2)
        assert runs(store) == expected
        print("%d kB left: %d of %d runs stored, then all: %s" %
              (leave_kb, there, len(expected), said.strip().splitlines()[-1]))
        subprocess.run(["umount", disk], check=True)


def disk_of_the_work_folder_fills_up(study, folder, expected):
    for reuse in (1, 8):
        store = os.path.join(folder, "work%d.db" % reuse)
        mount(store + ".work", "size=64k")
        said = study.run(store, "--reuse", reuse, code=3)
        expect(said, store + ".work", "cannot be written", "No space left on device")
        there = sound_part(store, expected)
        assert there < len(expected)
        subprocess.run(["umount", store + ".work"], check=True)
        study.run(store, "--reuse", reuse)
        assert runs(store) == expected
        print("work folder full, --reuse %d: %d runs stored, then all" % (reuse, there))


def folder_is_read_only(study, folder, expected):
    disk = os.path.join(folder, "fixed")
    store = os.path.join(disk, "study.db")
    mount(disk, "size=40m")
    remount(disk, "ro")
    expect(study.run(store, code=3), disk, "cannot write")
    remount(disk, "rw")
    study.run(store, "--filter", "straight")
    remount(disk, "ro")
    expect(study.run(store, code=3), disk, "cannot write")
    assert sound_part(store, expected) == len(expected) // 2
    remount(disk, "rw")
    study.run(store)
    assert runs(store) == expected
    print("a folder that was read-only: all stored in the end")


def inside(folder):
    mount(folder, "size=200m")
    study = Study(PROGRAM, PLUGINS, folder, PIPELINES, MORE)
    study.run(study.path("calm.db"), "--jobs", 2)
    expected = runs(study.path("calm.db"))
    disk_of_the_store_fills_up(study, folder, expected)
    disk_of_the_work_folder_fills_up(study, folder, expected)
    folder_is_read_only(study, folder, expected)
    assert not study.processes(), "processes are left"


def main():
    if len(sys.argv) > 4:
        inside(sys.argv[4])
        return
    separate = ["unshare", "-Urm", "--"]  # what is mounted goes with it
    with tempfile.TemporaryDirectory(prefix="altiplan_disk_") as folder:
        probe = subprocess.run(separate + ["mount", "-t", "tmpfs", "tmpfs", folder], check=False,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if probe.returncode != 0:
            print("skipped: no mount name space of its own: " + probe.stdout.strip())
            sys.exit(SKIPPED)
        sys.exit(subprocess.run(separate + [sys.executable, *sys.argv, folder],
                                check=False).returncode)


main()
