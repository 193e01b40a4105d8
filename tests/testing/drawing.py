"""Many examples of a strategy, always the same ones, to look at what it draws."""

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

# All that decides about the examples, whatever the profile is: tools/mutate has one that does not
# shrink.
QUICK = settings(
    max_examples=2000,
    database=None,
    derandomize=True,
    deadline=None,
    phases=[Phase.generate, Phase.target, Phase.shrink],
    suppress_health_check=[HealthCheck.too_slow],
)


def drawn(strategy: st.SearchStrategy, count: int = 600) -> list:
    cases = []

    @settings(QUICK, max_examples=count, phases=[Phase.generate])
    @given(strategy)
    def collect(case):
        cases.append(case)

    collect()
    return cases
