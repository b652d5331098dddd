"""A covering array: few choices of one level for each factor that hold every pair of levels that may stand together."""

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

Choice = dict[str, str]
"""A level for each factor."""

Pair = frozenset[tuple[str, str]]
"""Two levels, each with its factor."""

TRIES = 4
"""Choices of which the one that covers most is taken."""


def pairs_of(choice: Mapping[str, str]) -> Iterator[Pair]:
    """All pairs of a choice."""
    return map(frozenset, combinations(choice.items(), 2))


class Covering:
    """Makes choices until every pair is covered; `allows` says whether some levels may stand together."""

    def __init__(
        self, factors: Mapping[str, Sequence[str]], allows: Callable[[Choice], bool], seed: int
    ) -> None:
        self.factors, self.allows, self._chance = factors, allows, random.Random(seed)
        self.pairs = {
            frozenset(pair)
            for (a, ones), (b, others) in combinations(factors.items(), 2)
            for pair in (((a, one), (b, other)) for one in ones for other in others)
            if allows(dict(pair))
        }
        """Pairs that may stand together."""
        self.impossible: set[Pair] = set()
        """Pairs that no rule forbids, but that no whole choice could be found for."""

    def choices(self) -> Iterator[Choice]:
        """Choices, each of which covers many pairs that those before it lack."""
        missing = dict.fromkeys(sorted(self.pairs, key=sorted))
        while missing:
            first = self._chance.choice(list(missing))
            whole = [self._whole(dict(sorted(first)), missing) for _ in range(TRIES)]
            possible = [choice for choice in whole if choice]
            if possible:
                best = max(possible, key=lambda one: sum(pair in missing for pair in pairs_of(one)))
                yield best
                for pair in pairs_of(best):
                    missing.pop(pair, None)
            else:
                self.impossible.add(first)
                del missing[first]

    def _whole(
        self, start: Choice, missing: Mapping[Pair, None], attempts: int = 12
    ) -> Choice | None:
        """A choice of all factors with some given, whose other levels cover much that is missing."""
        for _ in range(attempts):
            choice = dict(start)
            others = [name for name in self.factors if name not in start]
            for name in self._chance.sample(others, k=len(others)):
                levels = [one for one in self.factors[name] if self.allows({**choice, name: one})]
                self._chance.shuffle(levels)
                gains = {
                    one: sum(frozenset((end, (name, one))) in missing for end in choice.items())
                    for one in levels
                }
                if not gains:
                    break
                choice[name] = max(gains, key=gains.__getitem__)
            else:
                return {name: choice[name] for name in self.factors}
        return None
