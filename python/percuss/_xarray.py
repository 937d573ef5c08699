"""Results as data sets of xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def dataset(
    variables: Mapping[str, tuple[tuple[str, ...], Any]],
    coordinates: Mapping[str, Any],
    **facts: Any,
) -> Any:
    """Make a data set of variables, each with the names of its dimensions.

    Raises
    ------
    ModuleNotFoundError
        Where xarray is not installed.
    """
    try:
        import xarray
    except ModuleNotFoundError:
        raise ModuleNotFoundError("to_xarray needs xarray", name="xarray") from None
    return xarray.Dataset(
        {name: (dimensions, np.asarray(value)) for name, (dimensions, value) in variables.items()},
        coords=coordinates,
        attrs=facts,
    )
