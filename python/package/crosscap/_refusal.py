"""Why there is no verified mesh."""

import json
from dataclasses import dataclass, field
from typing import NamedTuple


class Place(NamedTuple):
    """Where something is wrong.

    Attributes
    ----------
    kind : str
        ``"point"`` (a row of the input), ``"vertex"``, ``"triangle"``, ``"curve_edge"`` (an index into
        the arrays of the mesh), ``"edge"`` or ``"vertices"`` (two vertices), ``"triangles"`` (two triangles).
    index : int or tuple of int
        The index, or the two indices.
    """

    kind: str
    index: object  # type: ignore[assignment]


@dataclass(frozen=True)
class Reason:
    """One reason for a refusal, or one violation that a certificate found.

    Attributes
    ----------
    kind : str
        What is wrong: of a refusal ``"curvature"``, ``"edge"``, ``"open-end"``, ``"noise"``, ``"dimension"``, ``"unclaimed"``,
        ``"touching"``, ``"too-few-points"``, ``"outliers"``, ``"two-readings"``, ``"ends"``, ``"precision"`` or ``"unresolved"``;
        of a violation such as ``"undeclared_boundary"``.
    text : str
        The same in a sentence, with the worst place.
    count : int
        In how many places.
    places : tuple of Place
        The first of them: rows of the input, or for a violation parts of the mesh.
    coordinates : tuple of float
        Coordinates of the worst place, for a violation of the first one; empty where it has none.
    measure : float or None
        How bad it is there: in local spacings for noise; for curvature and too few points how many times as
        many points are wanted; for sheets that touch in a point the distance from it beyond which they are
        apart; for a violation of degree the worst value.
    level : str or None
        For a violation the level of the certificate, such as ``"edges"``.
    limit : float or None
        For a violation of degree the limit that was broken.
    advice : str
        For a violation what to change.
    """

    kind: str
    text: str
    count: int = 1
    places: tuple = ()
    coordinates: tuple = field(default=(), repr=False)
    measure: float | None = None
    level: str | None = None
    limit: float | None = None
    advice: str = ""


class Refusal(RuntimeError):
    """There is no mesh that may be handed over as good.

    Attributes
    ----------
    reasons : tuple of Reason
        What went wrong, one entry a kind, those of most places first.
    places : tuple of Place
        All places of all reasons.
    advice : str
        The best thing to do.
    attempts : list of dict
        What was tried: parameters, why these, how it ended, seconds.

    Examples
    --------
    >>> import crosscap
    >>> cloud = crosscap.sample("sphere", 200)
    >>> try:
    ...     crosscap.SurfaceReconstruction(eps=0.2, dl=0.1, surface=True).fit(cloud.points)
    ... except crosscap.Refusal as refusal:
    ...     print(len(refusal.reasons) > 0, refusal.advice != "")
    True True
    """

    def __init__(self, reasons, advice="", attempts=()):
        self.reasons = tuple(reasons)
        self.advice = advice
        self.attempts = list(attempts)
        told = [reason.text for reason in self.reasons] or ["there is no verified mesh"]
        super().__init__("\n".join([*told, advice] if advice else told))

    def __reduce__(self):
        return type(self), (self.reasons, self.advice, self.attempts)

    @property
    def places(self):
        return tuple(place for reason in self.reasons for place in reason.places)


class RefusalWarning(UserWarning):
    """There is no mesh that may be handed over as good, and the caller wants to go on."""


def _place(told):
    ((kind, index),) = told.items()
    return Place(kind, tuple(index) if isinstance(index, list) else index)


def _reason(told):
    return Reason(
        kind=told["kind"],
        text=told["text"],
        count=told["count"],
        places=tuple(_place(place) for place in told["places"]),
        coordinates=tuple(told["coordinates"] or ()),
        measure=told.get("measure", told.get("worst")),
        level=told.get("level"),
        limit=told.get("limit"),
        advice=told.get("advice") or "",
    )


def reasons(told):
    """The reasons that the extension module tells."""
    return tuple(_reason(one) for one in told)


def refusal(text):
    """The exception for a refusal that the extension module tells as JSON."""
    told = json.loads(text)
    return Refusal(reasons(told["reasons"]), told["advice"], told["attempts"])
