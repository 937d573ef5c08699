"""A small library with an integrator of its own: Bogacki and Shampine's method of order 3(2)."""

from mylib.method import BogackiShampine

__all__ = ["BogackiShampine"]
