"""Laws that plug-ins have to obey, and the kit that tries them.

A reconstruction relies on them: a metric that is not symmetric gives neighborhoods that do not fit
together. The kit is that of the Rust crate ``crosscap-core``; inputs are drawn, the same at every
run, and one that shows a broken law is made as small as it can be.
"""

from . import _crosscap, _plugins


class LawBroken(AssertionError):
    """Laws that a plug-in breaks, the more basic first.

    Attributes
    ----------
    law : str
        Name of the first law that is broken, such as ``"symmetry"``.
    found : str
        What the plug-in did.
    input : str
        The smallest input that was found to show it.
    laws : tuple of str
        Names of all laws that are broken.
    """

    def __init__(self, broken):
        self.broken = tuple(broken)
        self.law, self.found, self.input, _ = self.broken[0]
        self.laws = tuple(law for law, *_ in self.broken)
        super().__init__("\n\n".join(text for *_, text in self.broken))

    def __reduce__(self):
        return type(self), (self.broken,)


def check(plugin, *, instances=None, cases=128, seed=0xC205_5CA9):
    """Put a plug-in through the laws of its kind.

    Parameters
    ----------
    plugin : class, object or function
        A metric: a function of a point and an array of points, or a class whose instances are made of
        an array of points and have ``distances(i, rows)``. Or an estimator: something with
        ``estimate(points, distances, radius)``. Or a singularity model: something with
        ``decompose(points, fitted, center, radius)``.
    instances : str, optional
        For a model, what it describes: ``"sheet"``, or the name of the model of the program that describes the
        same, such as ``"two-planes"``. The kit draws exact instances of it.
    cases : int, default=128
        Inputs drawn for every law.
    seed : int, optional
        What they are drawn from.

    Raises
    ------
    LawBroken
        With the law, the input and what was found.

    Examples
    --------
    >>> import numpy
    >>> import crosscap
    >>> def taxicab(x, rows):
    ...     return numpy.abs(rows - x).sum(axis=1)
    >>> crosscap.laws.check(taxicab)
    >>> def squared(x, rows):
    ...     return ((rows - x) ** 2).sum(axis=1)
    >>> try:
    ...     crosscap.laws.check(squared)
    ... except crosscap.laws.LawBroken as broken:
    ...     print(broken.law)
    triangle inequality
    """
    if _plugins.is_model(plugin):
        if instances is None:
            raise ValueError("instances is missing: what the model describes, such as 'two-planes'")
        broken = _crosscap.laws_of_model(_plugins.model(plugin), instances, cases, seed)
    elif _plugins.is_estimator(plugin):
        broken = _crosscap.laws_of_estimator(_plugins.estimator(plugin), cases, seed)
    elif _plugins.is_metric(plugin) and not isinstance(plugin, type):
        raise ValueError("give the class of the metric: the kit builds it over points of its own")
    else:
        broken = _crosscap.laws_of_metric(_plugins.metric(plugin), cases, seed)
    if broken:
        raise LawBroken(broken)
