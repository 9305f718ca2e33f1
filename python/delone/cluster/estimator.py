"""The interface of scikit-learn's clusterers, without scikit-learn."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_plain_array, as_text, require_finite
from delone._base.georeference import crs_of, warn_of_degrees
from delone._base.immutable import own_copy
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Clusterer", "numbered"]

_METRICS = ("euclidean", "l2")


class Clusterer:
    """A clusterer whose options are the arguments of its constructor.

    The constructor of a subclass stores each argument unchanged under its own name; `fit` checks
    them. So scikit-learn can clone it and set its options.
    """

    _estimator_type = "clusterer"

    labels_: Indices
    crs_: str | None
    metric: str
    planar: bool

    @classmethod
    def _names(cls) -> list[str]:
        return sorted(set(inspect.signature(cls).parameters))

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """Return the options, by name.

        Parameters
        ----------
        deep : bool, optional
            Without effect, since no option is an estimator.

        Returns
        -------
        dict
            The arguments of the constructor.

        Examples
        --------
        >>> from delone.cluster import DBSCAN
        >>> DBSCAN(0.25).get_params()["eps"]
        0.25
        """
        return {name: getattr(self, name) for name in self._names()}

    def set_params(self, **params: Any) -> Self:
        """Change options, which `fit` will use.

        Parameters
        ----------
        **params
            Arguments of the constructor.

        Returns
        -------
        The estimator itself.

        Raises
        ------
        InputError
            A name is not an option.

        Examples
        --------
        >>> from delone.cluster import DBSCAN
        >>> DBSCAN().set_params(eps=2).eps
        2
        """
        unknown = sorted(set(params) - set(self._names()))
        if unknown:
            known = ", ".join(self._names())
            raise InputError(
                f"{type(self).__name__} has no option {', '.join(unknown)}; there are {known}"
            )
        for name, value in params.items():
            setattr(self, name, value)
        return self

    def fit(self, X: ArrayLike, y: Any = None) -> Self:  # noqa: N803
        """Cluster points.

        Parameters
        ----------
        X : array_like, shape (n, 2) or (n, 3)
            Finite coordinates.
        y : optional
            Ignored.

        Returns
        -------
        The estimator itself.

        Raises
        ------
        InputError
            An option is out of range, or the metric is not Euclidean.
        NonFiniteError
            A coordinate is NaN or infinite.
        ShapeError, DtypeError
            `X` is not a real array of shape (n, 2) or (n, 3), or an option has the wrong type.

        Examples
        --------
        >>> from delone.cluster import DBSCAN
        >>> DBSCAN(1.5, min_samples=2).fit([(0, 0), (9, 9), (1, 1)]).labels_
        array([ 0, -1,  0], dtype=int32)
        """
        self._cluster(X)
        return self

    def _cluster(self, given: ArrayLike) -> None:
        """Check the options, and set the attributes that a fitted estimator has."""
        raise NotImplementedError

    def fit_predict(self, X: ArrayLike, y: Any = None, **options: Any) -> Indices:  # noqa: N803
        """Cluster points and return their labels.

        Parameters
        ----------
        X : array_like, shape (n, 2) or (n, 3)
            Finite coordinates.
        y : optional
            Ignored.
        **options
            As for `fit`.

        Returns
        -------
        ndarray of int32, shape (n,)
            ``labels_``.

        Examples
        --------
        >>> from delone.cluster import DBSCAN
        >>> DBSCAN(1.5, min_samples=2).fit_predict([(0, 0), (9, 9), (1, 1)])
        array([ 0, -1,  0], dtype=int32)
        """
        return self.fit(X, y, **options).labels_

    def __repr__(self) -> str:
        parameters = inspect.signature(type(self)).parameters
        changed = [
            f"{name}={value!r}"
            for name, value in self.get_params().items()
            if value is not parameters[name].default and value != parameters[name].default
        ]
        return f"{type(self).__name__}({', '.join(changed)})"

    def __sklearn_is_fitted__(self) -> bool:
        return hasattr(self, "labels_")

    def __sklearn_tags__(self) -> Any:
        """Return the tags by which scikit-learn, the only caller, handles estimators."""
        from sklearn.utils import InputTags, Tags, TargetTags

        return Tags(
            estimator_type="clusterer",
            target_tags=TargetTags(required=False),
            transformer_tags=None,
            classifier_tags=None,
            regressor_tags=None,
            input_tags=InputTags(),
        )

    def _points(self, points: Any) -> Floats:
        """Return finite 2-D or 3-D points unchanged, after checking the metric."""
        if as_text(self.metric, name="metric") not in _METRICS:
            raise InputError(
                f"metric {self.metric!r:.80} is not available: distances are Euclidean, and exact; "
                "project longitudes and latitudes, or use scikit-learn for other metrics"
            )
        array = as_plain_array(points, "points")
        has_points = hasattr(points, "crs") and hasattr(points, "geometry")
        if not has_points and array.ndim == 2 and array.shape[1] not in (2, 3):
            raise ShapeError(
                f"points must have 2 or 3 coordinates, got shape {array.shape}; for other "
                "dimensions, use scikit-learn"
            )
        own = own_copy(points, ndim=None)
        warn_of_degrees(points, own, planar=self.planar)
        require_finite(own)
        self.n_features_in_ = own.shape[1]
        self.crs_ = crs_of(points)
        names = getattr(points, "columns", None)
        if names is not None and all(isinstance(name, str) for name in names):
            self.feature_names_in_ = np.array(list(names), dtype=object)
        elif hasattr(self, "feature_names_in_"):
            del self.feature_names_in_
        return own


def numbered(clusters: NDArray[np.integer[Any]]) -> Indices:
    """Return labels numbered by first rows, for clusters with any numbers, (n,); -1 remains."""
    found, first, inverse = np.unique(clusters, return_index=True, return_inverse=True)
    number = np.empty(len(found), dtype=np.int32)
    order = np.argsort(first)
    order = order[found[order] >= 0]
    number[found < 0] = -1
    number[order] = np.arange(len(order), dtype=np.int32)
    labels: Indices = number[inverse.ravel()]
    return labels
