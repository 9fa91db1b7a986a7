class LawBroken(AssertionError):
    broken: tuple[tuple[str, str, str, str], ...]
    law: str
    found: str
    input: str
    laws: tuple[str, ...]
    def __init__(self, broken: object) -> None: ...

def check(
    plugin: object, *, instances: str | None = None, cases: int = 128, seed: int = 0xC2055CA9
) -> None: ...
