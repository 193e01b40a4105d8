"""Declarations of a subject, each checked: what is missing or no such word is said by its name."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, NamedTuple

from ....errors import InputError, safe_repr
from ....model.chain import Chain
from ..process.calls import made


class Declarations(NamedTuple):
    """Attributes of a subject: its title, for messages, and the subject itself."""

    title: str
    own: Any

    def attribute(self, name: str) -> Any:
        """Value of an attribute; None where there is none."""
        value, fault = made(lambda: getattr(self.own, name, None))
        if fault:
            raise InputError(f"{self.title}: {name}: {fault}")
        return value

    def choice(
        self,
        what: str,
        words: tuple[str, ...],
        function: str,
    ) -> str:
        """Declaration that is one of some words, and that a function needs."""
        value = self.attribute(what)
        choice = " or ".join(f'"{word}"' for word in words)
        if value is None:
            raise InputError(
                f"{self.title} has {function}, and does not declare {what}: expected {what} = {choice}"
            )
        if not isinstance(value, str) or value not in words:
            raise self._expected(what, choice, value)
        return value

    def flag(self, what: str) -> bool:
        """Declaration that is True or False; False where it is missing."""
        return bool(self._of_kind(what, bool, "True or False"))

    def noise(self) -> float:
        """Noise that entries of rotations may have; 0 where it is not declared."""
        expected = "a number from 0 to 1e-5"
        value = self._of_kind("noise", int | float, expected) or 0.0
        if not 0 <= value <= 1e-5:
            raise self._expected("noise", expected, value)
        return float(value)

    def pastes(self) -> dict[str, str]:
        """Python texts that call the functions, by their names."""
        texts = self._of_kind("paste", Mapping, "a text for each function") or {}
        return {str(name): str(text) for name, text in texts.items()}

    def arm(self) -> Chain | None:
        """The one arm that fk and jacobian are of, if it is declared."""
        return self._of_kind("arm", Chain, "a poekin.Chain")

    def check_parameters(
        self,
        name: str,
        expected: str,
        hint: str,
    ) -> None:
        """Check that a function takes the parameters expected."""
        function = getattr(self.own, name)
        try:
            given = inspect.signature(function)
            given.bind(*expected.split(", "))
        except TypeError:
            raise InputError(
                f"{self.title}: {name}: expected parameters ({expected}){hint}, got {given}"
            ) from None
        except ValueError:  # compiled, without a signature; or a method that takes not even itself
            if inspect.ismethod(function):
                raise InputError(
                    f"{self.title}: {name}: expected parameters (self, {expected}), got none"
                ) from None

    def _of_kind(
        self,
        what: str,
        kind: Any,
        expected: str,
    ) -> Any:
        """Declaration of a kind; None where it is missing."""
        value = self.attribute(what)
        if not isinstance(value, kind | None):
            raise self._expected(what, expected, value)
        return value

    def _expected(
        self,
        what: str,
        expected: str,
        value: object,
    ) -> InputError:
        return InputError(f"{self.title}: {what}: expected {expected}, got {safe_repr(value)}")
