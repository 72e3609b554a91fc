"""Types of the fields of records: finite numbers, and what a setting may be."""

from typing import Annotated

from pydantic import ConfigDict, Field

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(allow_inf_nan=False, ge=0)]
Vector = tuple[Finite, ...]
Scalar = bool | int | Finite | str
Mapping = dict[str, Scalar]

# Every record refuses a field that it does not know: a misspelt name in a file is an error, not a default.
RECORD = ConfigDict(extra="forbid")
