from tests.cases import conftest as cases_conftest

_fake_method = cases_conftest._fake_method  # races are tried on the fabricated case
