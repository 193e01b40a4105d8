"""Tools that look at models: count the operations of an algorithm, validate a robot against an
oracle.
"""

from .counting.count import Count, count
from .validate import ChainErrors, Validation, chain_errors, validate

__all__ = ["ChainErrors", "Count", "Validation", "chain_errors", "count", "validate"]
