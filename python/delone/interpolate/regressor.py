"""Interpolation as a scikit-learn estimator (extra ``learn``).

Importing this module requires scikit-learn; `delone.interpolate` imports it lazily, when
`DelaunayRegressor` is accessed.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.georeference import names_degrees, warn_of_degrees
from delone.errors import DtypeError, MissingExtraError
from delone.interpolate.methods import interpolator

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.utils.validation import check_is_fitted, validate_data
except ImportError as error:
    raise MissingExtraError(
        'DelaunayRegressor needs scikit-learn, which is not installed: pip install "delone[learn]"',
        extra="learn",
    ) from error

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["DelaunayRegressor"]


class DelaunayRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Regression by interpolation of scattered 2-D points.

    Parameters
    ----------
    method : str, optional
        As in `interpolator`.
    extrapolate : {"nearest", "linear", "nan", "raise"}, optional
        Behavior outside the hull of the training points.
    tolerance : float, optional
        Queries outside at most this far from the hull are inside; as in `Linear`.
    duplicates : str, optional
        The value of training points that coincide but have different values; as in `Linear`, but by
        default their mean.
    columns : pair of int, optional
        The two features that are the coordinates. By default there must be exactly two.
    workers : int, optional
        Number of threads.
    planar : bool, optional
        As in `Linear`: treat features named longitude and latitude as coordinates of a plane.

    Attributes
    ----------
    interpolator_ : Interpolator
        Made by `fit`.
    n_features_in_ : int
        Number of features.

    Notes
    -----
    With ``columns=(0, 1)`` the estimator passes ``check_estimator``, scikit-learn's own checks. The
    default does not, as these use more than two features and it does not guess which ones are
    coordinates. Training points must span an area.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import DelaunayRegressor
    >>> X = np.random.default_rng(0).random((200, 2))
    >>> model = DelaunayRegressor("linear").fit(X, X[:, 0] + 2 * X[:, 1])
    >>> model.predict([[0.5, 0.25]]).round(9)
    array([1.])
    """

    def __init__(
        self,
        method: str = "linear",
        *,
        extrapolate: str = "nearest",
        tolerance: float = 0.0,
        duplicates: str = "mean",
        columns: tuple[int, int] | None = None,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        self.method = method
        self.extrapolate = extrapolate
        self.tolerance = tolerance
        self.duplicates = duplicates
        self.columns = columns
        self.workers = workers
        self.planar = planar

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:  # noqa: N803
        """Triangulate the training points.

        Parameters
        ----------
        X : array_like, shape (n, 2)
            Training points; with further features if `columns` is given.
        y : array_like, shape (n,) or (n, k)
            Their values.

        Returns
        -------
        DelaunayRegressor
            The estimator itself.

        Raises
        ------
        ValueError
            The number of features is not two, or the points span no area.

        Examples
        --------
        See `DelaunayRegressor`.
        """
        X, y = validate_data(  # noqa: N806
            self, X, y, multi_output=True, y_numeric=True, ensure_min_samples=3, dtype=np.float64
        )
        plane = self._plane(X)
        names = getattr(self, "feature_names_in_", ())
        by = "features " + ", ".join(names) if names_degrees(names) else None
        warn_of_degrees(None, plane, planar=self.planar, name="training points", by=by)
        self.interpolator_ = interpolator(
            plane,
            np.asarray(y, dtype=np.float64),
            self.method,
            extrapolate=self.extrapolate,
            tolerance=self.tolerance,
            duplicates=self.duplicates,
            workers=self.workers,
        )
        return self

    def predict(self, X: ArrayLike) -> NDArray[np.float64]:  # noqa: N803
        """Interpolate at the given points.

        Parameters
        ----------
        X : array_like, shape (n, 2)
            Points; with the same number of features as in `fit`.

        Returns
        -------
        ndarray of float64, shape (n,) or (n, k)
            Values.

        Raises
        ------
        ValueError
            The number of features differs from that in `fit`, or a value is NaN or infinite.
        NotFittedError
            `fit` has not been called.

        Examples
        --------
        See `DelaunayRegressor`.
        """
        check_is_fitted(self)
        X = validate_data(self, X, reset=False, dtype=np.float64)  # noqa: N806
        return self.interpolator_(self._plane(X))

    def _plane(self, X: Any) -> NDArray[np.float64]:  # noqa: N803
        """The two features that are coordinates."""
        if self.columns is None:
            if self.n_features_in_ != 2:
                raise ValueError(
                    "DelaunayRegressor needs 2-D points: 2 features, not "
                    f"{self.n_features_in_} feature(s); choose two with columns="
                )
            return np.asarray(X)
        try:
            first, second = map(operator.index, self.columns)
        except (TypeError, ValueError):
            raise DtypeError(f"columns must be two integers, got {self.columns!r:.60}") from None
        count = self.n_features_in_
        if not all(-count <= column < count for column in (first, second)):
            raise ValueError(f"columns={self.columns} are not among {count} feature(s)")
        return np.ascontiguousarray(np.asarray(X)[:, [first, second]])

    def __sklearn_tags__(self) -> Any:
        """Return the tags by which scikit-learn chooses its checks."""
        tags = super().__sklearn_tags__()
        tags.target_tags.multi_output = True
        # The random data of the checks has more than two features, and 2-D cannot fit it.
        tags.regressor_tags.poor_score = True
        return tags
