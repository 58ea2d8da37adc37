# SPDX-License-Identifier: Apache-2.0
"""_worker.py FILE: the process in which a file of plugins runs; altiplan talks to it at descriptor 3.

A message is two lengths, a header in JSON and float64 numbers. A first process keeps the second, which
runs the file: it tells how that ended, and ends it with altiplan."""
import faulthandler
import importlib.util
import json
import os
import select
import signal
import socket
import struct
import sys
import threading
import traceback
import types
import typing
from array import array

_Json = typing.Dict[str, typing.Any]
_Message = typing.Tuple[_Json, "array[float]"]
_Answer = typing.Tuple[_Json, typing.Iterable[float]]
_LENGTHS = struct.Struct("<II")  # bytes of the header, numbers after it
_MAX_BYTES, _MAX_NUMBERS = 1 << 28, 1 << 27
_LONGEST_TRACE = 10_000  # characters


def packed(header: _Json, numbers: typing.Any = ()) -> bytes:
    """A message; ValueError for one that the program would not take."""
    text = json.dumps(header, ensure_ascii=False).encode("utf-8", "replace")
    values: "array[float]" = numbers if isinstance(numbers, array) else array("d", numbers)
    if len(text) > _MAX_BYTES or len(values) > _MAX_NUMBERS:
        raise ValueError(f"an answer of {len(text)} bytes and {len(values)} numbers: expected at most "
                         f"{_MAX_BYTES} and {_MAX_NUMBERS}")
    return _LENGTHS.pack(len(text), len(values)) + text + values.tobytes()


class Connection:
    """Messages to and from the program."""

    def __init__(self, descriptor: int):
        self._socket = socket.socket(fileno=descriptor)
        self._bytes = bytearray()
        self._asking = threading.Lock()  # of threads of a planner
        self.stopped = False

    def send(self, header: _Json, numbers: typing.Any = ()) -> None:
        self.send_packed(packed(header, numbers))

    def send_packed(self, message: bytes) -> None:
        self._socket.sendall(message)

    def _taken(self) -> typing.Optional[_Message]:
        """The first whole message; None while it is incomplete."""
        if len(self._bytes) < _LENGTHS.size:
            return None
        text, count = _LENGTHS.unpack_from(self._bytes)
        end = _LENGTHS.size + text + 8 * count
        if len(self._bytes) < end:
            return None
        header = json.loads(self._bytes[_LENGTHS.size:_LENGTHS.size + text])
        numbers = array("d", bytes(self._bytes[_LENGTHS.size + text:end]))
        del self._bytes[:end]
        return header, numbers

    def _fill(self) -> None:
        # More would be mapped and unmapped by the allocator at each message, however short.
        received = self._socket.recv(1 << 16)
        if not received:
            os._exit(0)  # the program has ended, or wants no more
        self._bytes += received

    def receive(self) -> _Message:
        """The next message that is not a stop."""
        while True:
            message = self._taken()
            if message is None:
                self._fill()
            elif "stop" in message[0]:
                self.stopped = True
            else:
                return message

    def is_stopped(self) -> bool:
        """Reads what has come: while nothing is asked, that is a stop alone."""
        if not self.stopped and self._asking.acquire(blocking=False):
            try:
                while not self.stopped and select.select([self._socket], [], [], 0)[0]:
                    self._fill()
                    self.stopped = self._taken() is not None
            finally:
                self._asking.release()
        return self.stopped

    def ask(self, question: _Json, numbers: typing.Iterable[float]) -> _Message:
        with self._asking:
            self.send(question, numbers)
            return self.receive()


def keep(descriptor: int) -> None:
    """Forks, and returns in the child; this process ends with it or with the connection."""
    woken, wakes = os.pipe()
    os.set_blocking(wakes, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(wakes)
    child = os.fork()
    if child == 0:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        os.close(woken)
        os.close(wakes)
        return
    events = select.poll()
    events.register(descriptor, select.POLLRDHUP)
    events.register(woken, select.POLLIN)
    wanted, ended = True, 0
    while not ended:
        if any(number == descriptor for number, _ in events.poll()):
            wanted = False
            os.kill(child, signal.SIGKILL)
        elif wanted:
            os.read(woken, 512)
        ended, status = os.waitpid(child, os.WNOHANG if wanted else 0)
    if wanted:
        how = os.waitstatus_to_exitcode(status)
        try:
            Connection(descriptor).send({"ended": how})
        except OSError:
            pass  # the program has ended too
    os.killpg(0, signal.SIGKILL)  # what the file has started, and this process


def place_of(error: BaseException, file: str) -> str:
    """"FILE:LINE" of an exception: where the planner's own file was, else where it was raised."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{os.path.basename(error.filename)}:{error.lineno}"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if frame.filename == file]
    at = own or [frame for frame in frames if not frame.filename.startswith(os.path.dirname(__file__))]
    return f"{os.path.basename(at[-1].filename)}:{at[-1].lineno}" if at else ""


def failure(error: BaseException, file: str, api: typing.Any) -> _Json:
    """An exception as a message."""
    place = place_of(error, file)
    if place:  # else it is about what was returned, and no line of the file's
        lines = "".join(traceback.format_exception(type(error), error, error.__traceback__))
        print(lines[-_LONGEST_TRACE:], file=sys.stderr, end="", flush=True)  # for its author
    if isinstance(error, SystemExit):
        return {"failed": f"ended the process by sys.exit({error.code!r})", "how": "exit",
                "place": place}
    text = api.returned.text(traceback.format_exception_only(type(error), error)[-1].strip())
    return {"failed": text, "how": "memory" if isinstance(error, MemoryError) else "threw",
            "place": place}


def planned(call: typing.Callable[..., typing.Any], arguments: typing.List[typing.Any],
            api: typing.Any) -> _Answer:
    """What plan or smooth returns, as a message."""
    request = arguments[-1]
    try:
        returned = call(*arguments)
    except api.NoRoute as reason:
        returned = reason
    counters = {}
    if isinstance(returned, tuple) and len(returned) == 2 and isinstance(returned[1], dict):
        returned, counters = returned
    for name, value in counters.items():
        if not hasattr(value, "__index__"):
            raise TypeError(f"the counter '{name}': expected a whole number, found {value!r}")
    counters = {"expanded": request.budget.expanded,
                **{str(name): int(value) for name, value in counters.items()}}
    answer: _Json = {"counters": counters, "spent": request.budget.was_spent}
    if returned is None or isinstance(returned, api.NoRoute):
        answer["none"] = "" if returned is None else api.returned.text(returned)
        answer["proved"] = getattr(returned, "proved", False)
        return answer, ()
    return answer, api.given.numbers_of(returned, 3, "the returned route")


class Worker:
    """Answers the program's messages."""

    def __init__(self, file: str, api: typing.Any, connection: Connection):
        self._file, self._api, self._connection = file, api, connection
        self._object: typing.Any = None
        self._kind = ""

    def _load(self) -> None:
        # A name of its own, since numpy.py would stand for numpy.
        name = "plugin_" + os.path.splitext(os.path.basename(self._file))[0]
        spec = importlib.util.spec_from_file_location(name, self._file)
        assert spec is not None and spec.loader is not None  # of a file that ends in .py
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module  # dataclasses look for it there
        spec.loader.exec_module(module)

    def _answer(self, message: _Json, numbers: "array[float]") -> _Answer:
        if "load" in message:
            self._load()
            return {"plugins": [self._api.described(one) for one in self._api.offered]}, ()
        if "make" in message:
            plugin = next(one for one in self._api.offered
                          if (one["kind"], one["name"]) == (message["kind"], message["make"]))
            self._kind = plugin["kind"]
            self._object = self._api.constructed(plugin, message["with"])
            return self._api.properties_of(plugin["kind"], self._object), ()
        self._connection.stopped = False
        return self._called(next(iter(message)), message, numbers)

    def _called(self, task: str, message: _Json, numbers: "array[float]") -> _Answer:
        """The answer of a method of the object: the message begins with its name."""
        method, ask, returned = getattr(self._object, task), self._connection.ask, self._api.returned
        if task == "admits":
            return {"yes": returned.admitted(method(self._api.given.Leg(numbers, ask)))}, ()
        if task == "build":
            built = method(self._api.given.Site(message[task], ask))
            layer: _Answer = (returned.field if self._kind == "objective" else returned.built)(built)
            return layer
        request = self._api.given.Request(message[task], ask, self._connection.is_stopped)
        if task == "tighten":
            return {"limits": returned.limits(method(request))}, ()
        if task == "plan":
            return planned(method, [request], self._api)
        points = self._api.given.listed(numbers, 3)
        if task == "smooth":
            return planned(method, [points, request], self._api)
        return {"violations": returned.violations(method(points, request), len(points))}, ()

    def serve(self) -> None:
        own = os.getpid()
        while True:
            message, given = self._connection.receive()
            try:
                answer = packed(*self._answer(message, given))
            except BaseException as error:
                answer = packed(failure(error, self._file, self._api))
            if os.getpid() != own:
                os._exit(0)  # a copy that the planner has forked has nothing to say
            self._connection.send_packed(answer)


def light_package() -> typing.Any:
    """The package with what planners need alone; the rest would start the program a second time."""
    package = types.ModuleType("altiplan")
    package.__path__ = [os.path.dirname(os.path.abspath(__file__))]
    sys.modules["altiplan"] = package
    from altiplan import _planner, _request, _returned

    for name in ("Cells", "Field", "Ground", "NoRoute", "constraint", "environment", "objective",
                 "parameter", "parameters", "planner", "smoother"):
        setattr(package, name, getattr(_planner, name))
    setattr(_planner, "given", _request)
    setattr(_planner, "returned", _returned)
    return _planner


def main() -> None:
    file = sys.argv[1]
    keep(3)
    faulthandler.enable()
    connection = Connection(3)
    connection.send({"process": os.getpid()})
    sys.path[0:1] = []
    sys.path.append(os.path.dirname(file))  # at the end: a file numpy.py is not numpy
    sys.argv = [file]
    Worker(file, light_package(), connection).serve()


if __name__ == "__main__":
    main()
