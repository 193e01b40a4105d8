"""The search for the n of K candidates that show most."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from poekin.solve.calibration.design import exchange as search
from poekin.solve.calibration.design.exchange import CRITERIA, exchange
from poekin.solve.calibration.design.greedy import greedy

EPS = np.finfo(float).eps
EXTREMES = ("amplification", "condition", "smallest")


def criterion(blocks, chosen, by):  # type: ignore[no-untyped-def]
    """The criterion from its definition, by singular values and least squares; larger is better."""
    J = blocks[list(chosen)].reshape(-1, blocks.shape[2])
    if by == "prediction":
        everything = blocks.reshape(-1, blocks.shape[2])
        return 1 / np.linalg.norm(everything @ np.linalg.pinv(J))
    s = np.linalg.svd(J, compute_uv=False)
    return {
        "amplification": s[-1] ** 2 / s[0], "O1": float(np.prod(s ** (1 / len(s)))),
        "condition": s[-1] / s[0], "smallest": s[-1],
    }[by]  # fmt: skip


def nothing(blocks):  # type: ignore[no-untyped-def]
    """The rows of what was measured before, where nothing was."""
    return np.empty((0, blocks.shape[2]))


@st.composite
def candidates(draw, most=9, wide=14):  # type: ignore[no-untyped-def]
    """Blocks (K, r, L) whose columns have scales of their own, and an n of which n r >= L."""
    r, L = draw(st.integers(1, 4)), draw(st.integers(1, wide))
    least = -(-L // r) + 1
    n = draw(st.integers(least, least + 2))
    count = n + draw(st.integers(1, most))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    scales = 10 ** np.array(draw(st.lists(st.floats(-1, 1), min_size=L, max_size=L)))
    return rng.normal(size=(count, r, L)) * scales, n


@pytest.mark.parametrize("by", CRITERIA)
@given(candidates())
@settings(max_examples=40, deadline=None)
def test_no_single_exchange_makes_the_choice_better(by, case):
    blocks, n = case
    chosen = list(exchange(blocks, n, by))
    found = criterion(blocks, chosen, by)
    others = [j for j in range(len(blocks)) if j not in chosen]
    best = max(
        criterion(blocks, [*chosen[:k], j, *chosen[k + 1 :]], by) for k in range(n) for j in others
    )
    # the search works on squares: eigenvalues that lie 1e8 below the largest have eight digits
    assert best <= found * (1 + 1e-6)
    assert len(set(chosen)) == n
    assert chosen == sorted(chosen)


@pytest.mark.parametrize("by", CRITERIA)
@given(candidates(wide=20), st.integers(0, 99))
@settings(max_examples=40, deadline=None)
def test_no_exchange_is_worth_more_than_it_promises(by, case, place):
    blocks, n = case
    chosen = np.array(greedy(blocks, n))
    mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    of = search.Search(blocks, by, mean, nothing(blocks))
    promised = search.upper_bound(of, search.design_state(of, chosen), blocks[chosen[place % n]])
    kept = np.delete(chosen, place % n)
    for j in set(range(len(blocks))) - set(chosen):
        N = np.einsum("kri,krj->ij", blocks[[*kept, j]], blocks[[*kept, j]])
        true = float(search.value(N, by, mean))
        if true < -25:  # a set that leaves a direction unseen to rounding: its value is one
            continue
        assert promised[j] >= true - 1e-6
        if by in ("O1", "prediction"):
            assert promised[j] == pytest.approx(true, abs=1e-6)


@pytest.mark.parametrize("by", CRITERIA)
@given(candidates())
@settings(max_examples=20, deadline=None)
def test_the_value_orders_sets_as_the_definition_does(by, case):
    blocks, n = case
    mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    a, b = np.arange(n), np.arange(len(blocks) - n, len(blocks))
    values, defined = [], []
    for some in (a, b):
        J = blocks[some].reshape(-1, blocks.shape[2])
        values.append(float(search.value(J.T @ J, by, mean)))
        defined.append(float(np.log(criterion(blocks, some, by))))
    # logarithms of squares; of O1 that of the determinant
    factor = 2 * blocks.shape[2] if by == "O1" else 2
    assert values[1] - values[0] == pytest.approx(factor * (defined[1] - defined[0]), abs=1e-5)


@pytest.mark.parametrize("by", CRITERIA)
def test_the_candidates_that_show_ten_times_as_much_are_found_among_many(by):
    rng = np.random.default_rng(5)
    blocks = rng.normal(size=(300, 2, 12))
    good = np.array([3, 50, 51, 170, 222, 299])
    blocks[good] = 20 * np.linalg.qr(rng.normal(size=(12, 12)))[0].reshape(6, 2, 12)
    assert exchange(blocks, 6, by).tolist() == good.tolist()


@pytest.mark.parametrize("by", CRITERIA)
def test_the_axes_of_the_measured_rows_do_not_matter_nor_how_many_of_them_say_the_same(by):
    rng = np.random.default_rng(2)
    blocks = rng.normal(size=(60, 3, 10))
    turned = (
        np.linalg.qr(rng.normal(size=(60, 40, 40)))[0][:, :, :3] @ blocks
    )  # (60, 40, 10), the same information
    assert exchange(turned, 8, by).tolist() == exchange(blocks, 8, by).tolist()


@pytest.mark.parametrize("by", EXTREMES)
def test_few_eigenvectors_find_the_same_choice_as_all_of_them(by, monkeypatch):
    blocks = np.random.default_rng(1).normal(size=(80, 3, 16))
    few = exchange(blocks, 9, by)
    monkeypatch.setattr(search, "LOWEST", 16)
    assert few.tolist() == exchange(blocks, 9, by).tolist()


@pytest.mark.parametrize("by", CRITERIA)
@pytest.mark.parametrize("decades", [6, 8, 10])
def test_it_ends_where_the_smallest_singular_value_is_rounding(by, decades):
    scales = 10 ** -np.linspace(0, decades, 9)
    chosen = exchange(np.random.default_rng(decades).normal(size=(60, 2, 9)) * scales, 7, by)
    assert len(set(chosen.tolist())) == 7


def test_all_of_the_candidates_are_a_choice():
    blocks = np.random.default_rng(0).normal(size=(5, 3, 6))
    assert exchange(blocks, 5).tolist() == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("by", CRITERIA)
@pytest.mark.parametrize("n", [1, 2])
def test_candidates_that_show_nothing_are_not_taken(by, n):
    blocks = np.zeros((7, n, n))
    blocks[[2, 4, 5]] = [k * np.eye(n) for k in (1.0, 3.0, 2.0)]
    found = exchange(blocks, n, by).tolist()
    # where all are as good as the first, none is exchanged
    assert set(found) <= {2, 4, 5}
    if by not in ("condition",):
        assert found == [4, 5][:n]


def test_the_greedy_start_sees_every_direction_as_soon_as_it_can():
    # each candidate sees one of twelve directions, the first of them many times as well as the last
    blocks = np.zeros((120, 1, 12))
    blocks[np.arange(120), 0, np.arange(120) % 12] = 10.0 ** -(np.arange(120) % 12 / 4)
    assert sorted(k % 12 for k in greedy(blocks, 12)) == list(range(12))


def test_progress_goes_forward_and_ends_at_its_total():
    said: list[tuple[int, int]] = []
    blocks = np.random.default_rng(3).normal(size=(50, 2, 8))
    exchange(blocks, 6, progress=lambda done, total: said.append((done, total)))
    done = [d for d, _ in said]
    assert done == sorted(done)
    assert all(d <= t for d, t in said)
    assert said[0][0] == 1
    assert said[-1][0] == said[-1][1]


def test_an_exchange_that_turns_out_worse_is_not_made(monkeypatch):
    blocks = np.random.default_rng(6).normal(size=(40, 2, 8))
    start = sorted(greedy(blocks, 6))
    worst = set(range(40)) - set(start)

    def wrong(of, state, chosen, place):  # type: ignore[no-untyped-def]
        others = [np.where(np.arange(6) == place, j, chosen) for j in worst - set(chosen)]
        return min((search.design_state(of, c).value, int(c[place])) for c in others)[1]

    def no_end(done, total):  # type: ignore[no-untyped-def]
        assert done < 1000

    monkeypatch.setattr(search, "best_exchange", wrong)
    assert exchange(blocks, 6, progress=no_end).tolist() == start


@pytest.mark.parametrize("by, expected", [
    ("smallest", np.log(EPS * 1e6)), ("condition", np.log(EPS)), ("amplification", 2 * np.log(EPS * 1e6) - np.log(1e6)),
    ("O1", np.log(EPS * 1e6) + np.log(100.0) + np.log(1e6)),
])  # fmt: skip
def test_what_is_not_seen_counts_as_rounding_of_what_is_seen_best(by, expected):
    N, mean = np.diag([0.0, 100.0, 1e6]), np.eye(3)
    assert float(search.value(N, by, mean)) == pytest.approx(expected)
    assert float(search.value(np.diag([-1e-9, 100.0, 1e6]), by, mean)) == pytest.approx(expected)
    assert np.isfinite(search.value(np.zeros((3, 3)), by, mean))
    both = search.value(np.stack([N, np.diag([4.0, 2.0, 1.0])]), by, mean)
    at_best = {
        "smallest": 0.0,
        "condition": -np.log(4),
        "amplification": -np.log(4),
        "O1": np.log(8),
    }[by]
    np.testing.assert_allclose(both, [expected, at_best], atol=1e-12)


def test_the_prediction_is_the_mean_variance_over_the_candidates():
    N, mean = np.diag([4.0, 2.0]), np.array([[3.0, 0.5], [0.5, 5.0]])
    assert float(search.value(N, "prediction", mean)) == pytest.approx(-np.log(3 / 4 + 5 / 2))


def test_all_is_said_to_take_nine_steps_for_each_of_the_chosen_at_first_and_never_less_than_was_done():
    said = []
    exchange(
        np.random.default_rng(3).normal(size=(50, 2, 8)),
        6,
        progress=lambda *step: said.append(step),
    )
    assert said[0] == (1, 54)
    assert all(total >= done + 6 for done, total in said[:-1])


def test_the_progress_of_a_search_of_many_steps_stays_a_choice_s_length_ahead_of_what_was_done(
    monkeypatch,
):
    """From the worst of 30 candidates to the next better one at a time: 1 greedy step, 29
    exchanges, 1 idle step.
    """
    blocks, said = np.arange(1.0, 31.0)[:, None, None], []
    monkeypatch.setattr(search, "greedy", lambda blocks, n, tick, given: tick() or [0])
    monkeypatch.setattr(
        search,
        "best_exchange",
        lambda of, state, chosen, place: int(chosen[0]) + 1 if chosen[0] < 29 else None,
    )
    assert exchange(blocks, 1, progress=lambda *step: said.append(step)) == [29]
    assert said == [(k, max(9, k + 1)) for k in range(1, 32)] + [(31, 31)]


@pytest.mark.parametrize("by", CRITERIA)
@pytest.mark.parametrize("together", [1, 3, 32])
def test_the_best_exchange_is_the_best_of_all_however_many_are_valued_together(
    by, together, monkeypatch
):
    monkeypatch.setattr(search, "TOGETHER", together)
    blocks = np.random.default_rng(4).normal(size=(90, 2, 6))
    mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    for seed in range(8):
        chosen = np.random.default_rng(seed).choice(90, 4, replace=False)
        of = search.Search(blocks, by, mean, nothing(blocks))
        state = search.design_state(of, chosen)
        others = [j for j in range(90) if j not in chosen]
        values = [
            search.design_state(of, np.array([chosen[0], j, *chosen[2:]])).value for j in others
        ]
        expected = others[int(np.argmax(values))] if max(values) > state.value else None
        assert search.best_exchange(of, state, chosen, 1) == expected


def test_the_greedy_start_takes_what_shows_a_new_direction_before_what_shows_an_old_one_well():
    """One candidate shows the first direction alone, by far the best; fifty show both, the first
    one hardly.
    """
    blocks = np.tile([[1e-3, 0.0], [0.0, 1.0]], (51, 1, 1))
    blocks[7] = [[10.0, 0.0], [0.0, 0.0]]
    assert 7 not in greedy(blocks, 1)
    assert greedy(blocks, 2)[1] == 7


def test_the_logarithm_of_what_is_not_positive_is_what_is_said():
    assert search._log(np.array([-2.0, 0.0, 1.0, np.e]), 7.0) == pytest.approx([7, 7, 0, 1])


def test_where_nothing_can_be_exchanged_each_place_is_looked_at_once():
    said: list[tuple[int, int]] = []
    exchange(
        np.random.default_rng(0).normal(size=(5, 3, 6)), 5, progress=lambda *step: said.append(step)
    )
    assert said == [*((k, 45) for k in range(1, 11)), (10, 10)]


@pytest.mark.parametrize("by", ["smallest", "condition", "amplification"])
def test_what_promises_more_on_all_eigenvectors_is_as_good_as_it_promises(by):
    blocks = np.random.default_rng(11).normal(size=(40, 2, 6))
    chosen = np.arange(5)
    of = search.Search(blocks, by, np.eye(6), nothing(blocks))
    state = search.design_state(of, chosen)
    promised = search.upper_bound(of, state, blocks[2])
    others = np.flatnonzero(promised[5:] > state.value) + 5
    assert len(others)
    for j in others:
        true = search.design_state(of, np.array([0, 1, j, 3, 4])).value
        assert promised[j] == pytest.approx(true, abs=1e-9)


@pytest.mark.parametrize("by", search.WITH_INVERSE)
def test_a_short_list_holds_what_promises_most(by, monkeypatch):
    blocks = np.random.default_rng(2).normal(size=(60, 2, 6))
    mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    chosen = np.array([3, 41, 7, 20])
    of = search.Search(blocks, by, mean, nothing(blocks))
    monkeypatch.setattr(search, "SHORTLIST", 10)
    listed = search.promising(of, chosen)
    assert listed[:4].tolist() == chosen.tolist()
    J = blocks[chosen].reshape(-1, 6)
    N = J.T @ J
    eps = 1e-6
    # the criterion's derivative by the weight of each candidate, by differences
    gains = [float(search.value(N + eps * B.T @ B, by, mean)) for B in blocks]
    order = [j for j in np.argsort(gains)[::-1] if j not in chosen]
    assert listed[4:].tolist() == order[:10]


def test_a_short_list_is_made_anew_as_long_as_exchanges_help(monkeypatch):
    rng = np.random.default_rng(2)
    blocks = rng.normal(size=(60, 2, 6)) * rng.uniform(0.3, 3, size=(60, 1, 1))
    monkeypatch.setattr(search, "SHORTLIST", 2)
    found = []
    for lists in (4, 1):
        monkeypatch.setattr(search, "LISTS", lists)
        found.append([criterion(blocks, exchange(blocks, n), "prediction") for n in range(3, 9)])
    assert all(more >= once for more, once in zip(*found, strict=True))
    # beyond rounding
    assert max(more / once for more, once in zip(*found, strict=True)) > 1 + 1e-6


@pytest.mark.parametrize("by", CRITERIA)
def test_what_was_measured_before_counts(by):
    """Of three directions two were seen before: the candidate that sees the third is taken."""
    blocks = np.eye(3)[[0, 0, 1, 2, 1]][:, None] * 2.0
    before = np.eye(3)[:2] * 2.0
    assert greedy(blocks, 1, given=before) == [3]
    assert exchange(blocks, 1, by, given=before).tolist() == [3]


def test_what_was_measured_before_counts_in_directions_of_another_scale_too():
    """Of two candidates that see the first direction, and one that sees the second half as well as it was seen
    before, the first two tell more.
    """
    scales = np.array([1e6, 1e-3])
    blocks = np.eye(2)[[0, 0, 1]][:, None] * scales
    assert greedy(blocks, 2, given=np.array([[0.0, 2.0]]) * scales) == [0, 1]


def test_what_is_predicted_may_be_elsewhere_than_what_is_measured():
    blocks = np.eye(2)[[0, 1, 0, 1, 0, 1]][:, None]
    for k, weights in enumerate(([100.0, 1.0], [1.0, 100.0])):
        found = exchange(blocks, 4, mean=np.diag(weights))
        # of each direction there are three: the one that counts is measured three times
        assert np.sum(found % 2 == k) == 3
