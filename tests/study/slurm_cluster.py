# SPDX-License-Identifier: Apache-2.0
"""A Slurm of one node on this machine: munged, slurmctld and slurmd in a folder of their own, as
whoever calls, without systemd. Nothing of it is left when the `with` ends."""
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time

CONFIG = """ClusterName=loopback
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
CredType=cred/munge
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
KillWait=2
NodeName=loop NodeHostname={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=100000 State=UNKNOWN
PartitionName=main Nodes=loop Default=YES MaxTime=INFINITE State=UP
"""
PATIENCE_S = 30
# Where Debian has the daemons, which need not be on the PATH of users.
DAEMONS = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])


class Unavailable(Exception):
    """Why there is no Slurm here."""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    def __enter__(self):
        self.daemons = []
        self.folder = tempfile.mkdtemp(prefix="altiplan_slurm_")
        try:
            self.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if len(self.daemons) == 3:
            # What steps still run would outlive the node's daemon.
            subprocess.run(["scancel", "--me", "--signal=KILL", "--full"], env=self.environment,
                           capture_output=True, timeout=PATIENCE_S)
            subprocess.run(["scancel", "--me"], env=self.environment, capture_output=True,
                           timeout=PATIENCE_S)
            self.wait_until(lambda: not self.running(), "no job is left", fails=False)
        for daemon in reversed(self.daemons):
            os.killpg(daemon.pid, signal.SIGTERM)
            try:
                daemon.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                os.killpg(daemon.pid, signal.SIGKILL)
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self):
        programs = [shutil.which(name, path=DAEMONS)
                    for name in ("munged", "slurmctld", "slurmd", "sbatch", "scontrol")]
        if None in programs:
            raise Unavailable("slurm-wlm and munge are not installed")
        os.chmod(self.folder, 0o755)  # or munged calls its socket unreachable
        for name in ("munge", "state", "spool"):
            os.mkdir(os.path.join(self.folder, name))
        munge = os.path.join(self.folder, "munge")
        with open(os.open(os.path.join(munge, "key"), os.O_WRONLY | os.O_CREAT, 0o400),
                  "wb") as key:
            key.write(os.urandom(128))
        try:
            user = pwd.getpwuid(os.getuid()).pw_name
        except KeyError:
            raise Unavailable("the user who calls has no name") from None
        controller_port, node_port = free_ports(2)
        config = os.path.join(self.folder, "slurm.conf")
        with open(config, "w") as stream:
            stream.write(CONFIG.format(folder=self.folder, user=user,
                                       host=socket.gethostname().split(".")[0],
                                       controller_port=controller_port, node_port=node_port))
        self.environment = {**os.environ, "SLURM_CONF": config, "PATH": DAEMONS}
        self.daemon(programs[0], "--foreground", f"--key-file={munge}/key",
                    f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                    f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait_until(lambda: os.path.exists(f"{munge}/socket"), "munged listens")
        self.daemon(programs[1], "-D", "-i")
        self.daemon(programs[2], "-D", "-N", "loop")
        self.wait_until(lambda: "idle" in self.say("sinfo", "--noheader", "--format=%t"),
                        "the node is idle")

    def daemon(self, *arguments):
        name = os.path.basename(arguments[0])
        with open(os.path.join(self.folder, name + ".out"), "w") as out:
            self.daemons.append(subprocess.Popen(
                arguments, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                env=self.environment, start_new_session=True))

    def say(self, *arguments):
        return subprocess.run(arguments, env=self.environment, capture_output=True, text=True,
                              timeout=PATIENCE_S).stdout

    def wait_until(self, happened, what, patience=PATIENCE_S, fails=True):
        end = time.monotonic() + patience
        while time.monotonic() < end:
            if happened():
                return
            dead = [daemon for daemon in self.daemons if daemon.poll() is not None]
            if dead and fails:
                raise Unavailable(f"{dead[0].args[0]} ended: {self.crash_report(dead[0])}")
            time.sleep(0.1)
        if fails:
            raise Unavailable(f"after {patience} s not: {what}; {self.logs()}")

    def crash_report(self, daemon):
        with open(os.path.join(self.folder, os.path.basename(daemon.args[0]) + ".out")) as out:
            return out.read()[-500:]

    def logs(self):
        return "; ".join(self.crash_report(daemon) for daemon in self.daemons)

    def queue(self):
        """State by the number of job or task, of those waiting, running or about to end."""
        lines = self.say("squeue", "--noheader", "--array", "--format=%i %T").splitlines()
        return dict(line.split() for line in lines)

    def running(self):
        return [job for job, state in self.queue().items() if state != "PENDING"]
