"""What the list of cases is made of."""

from collections.abc import Callable
from dataclasses import dataclass, field

#: Where a reference value may come from.
EXACT = "exact"
COMPUTED = "computed independently"
REPORTED = "reported"
LAW = "conservation law"
OWN = "finer cells"


@dataclass(frozen=True)
class Line:
    """One number of a case beside its reference: a row of the table."""

    #: What is compared.
    quantity: str
    #: Unit of both numbers; empty for a pure number.
    unit: str
    reference: float
    #: One of the constants above.
    kind: str
    #: The largest difference that is in order: a share of the reference or, with `absolute`, in the unit.
    allowed: float
    #: Why that much.
    reason: str
    #: The number itself, from the finished runs by label.
    measure: Callable
    #: Labels of the runs that `measure` reads.
    runs: tuple[str, ...] = ("",)
    absolute: bool = False
    #: Why it is not met, where that is known; nothing holds such a line, and the page says so.
    open: str = ""

    def difference(self, ours):
        """The difference as `allowed` counts it."""
        return ours - self.reference if self.absolute else ours / self.reference - 1


@dataclass(frozen=True)
class Picture:
    """A map of a field that `dgmpm plot` draws."""

    caption: str
    field: str
    run: str = ""
    #: s; the snapshot nearest to it.
    time: float | None = None
    #: The largest value of the colours, which go as far below 0; 0: those of the field.
    limit: float = 0.0


@dataclass(frozen=True)
class Case:
    """A scene with its runs and what is compared."""

    #: Its name in files.
    name: str
    title: str
    #: Below `meshes/`.
    scene: str
    #: What is solved, where the values come from, what it shows.
    text: str
    lines: list[Line]
    picture: Picture
    #: The runs: a label each (part of the name of the folder), and what they set otherwise than the scene.
    runs: dict[str, list[str]] = field(default_factory=lambda: {"": []})
    #: Labels of the runs that `make test` makes; it holds the lines that need no other one.
    quick: tuple[str, ...] = ()
