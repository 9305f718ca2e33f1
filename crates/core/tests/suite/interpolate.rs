//! Interpolation against the functions that it must reproduce, at every scale.

use delone_core::Point2;
use delone_core::base::arrays::Triangles;
use delone_core::base::watch::{IDLE, Watch};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::interpolate::{
    Field, Kind, Method as Left, Order, Table, clough_tocher, leave_one_out, linear, natural,
    natural_values,
};
use delone_core::locate::{Batch, Kept, Located, Locator};
use proptest::prelude::*;

/// A triangulation and its cache.
struct Made {
    points: Vec<Point2>,
    simplices: Vec<[i32; 3]>,
    neighbors: Vec<[i32; 3]>,
    kept: Kept,
}

impl Made {
    fn of(points: Vec<Point2>) -> Option<Self> {
        let made = triangulate(&points, Method::Auto, 1, &Watch::idle()).ok()?;
        let (simplices, neighbors) = (made.arrays.simplices, made.arrays.neighbors);
        let given = Triangles {
            points: &points,
            simplices: &simplices,
            neighbors: &neighbors,
        };
        let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
        Some(Self {
            points,
            simplices,
            neighbors,
            kept,
        })
    }

    fn given(&self) -> Triangles<'_> {
        Triangles {
            points: &self.points,
            simplices: &self.simplices,
            neighbors: &self.neighbors,
        }
    }

    fn is_inside(&self, q: Point2) -> bool {
        let located = Locator::new(self.given(), &self.kept, &IDLE).locate(q);
        matches!(located, Ok(Some(Located::Inside(_))))
    }

    /// All interpolants of one column.
    fn values(&self, values: &[f64], gradients: &[f64], queries: &[Point2]) -> Vec<Vec<f64>> {
        let given = self.given();
        let batch = Batch {
            locator: Locator::new(given, &self.kept, &IDLE),
            queries,
            workers: 2,
            watch: &Watch::idle(),
        };
        let field = Field::new(&given, values, Some(gradients), 1).expect("a field");
        let order = Order::Value;
        let mut all = vec![
            linear(&batch, field, order).expect("values"),
            clough_tocher(&batch, field, &[], order).expect("values"),
        ];
        for (_, kind) in Kind::NAMES {
            let found = natural_values(&batch, kind, field, &[], order);
            all.push(found.expect("values"));
            let (rows, _) = natural(&batch, kind, &[]).expect("weights");
            let table = Table {
                indptr: &rows.indptr,
                indices: &rows.indices,
                weights: &rows.weights,
                slopes: kind.is_smooth().then(|| rows.slopes.as_chunks().0),
            };
            let combined = table.combine(self.points.len(), field, 2, &Watch::idle());
            all.push(combined.expect("values"));
        }
        all
    }
}

fn scale() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(1.0),
        Just(2f64.powi(-1000)),
        Just(2f64.powi(1000)),
        Just(2f64.powi(-300)),
        Just(2f64.powi(400)),
    ]
}

proptest! {
    #[test]
    fn linear_functions_are_reproduced(
        points in prop::collection::vec((0..9i32, 0..9i32), 4..50),
        queries in prop::collection::vec((0..1000i32, 0..1000i32), 1..40),
        scale in scale(),
        offset in prop_oneof![Just(0.0), Just(5e6)],
    ) {
        let place = |x: f64, y: f64| [(x + offset) * scale, (y + offset / 2.0) * scale];
        let points: Vec<Point2> = points
            .into_iter()
            .map(|(x, y)| place(f64::from(x), f64::from(y)))
            .collect();
        let Some(made) = Made::of(points) else { return Ok(()) };
        let mut queries: Vec<Point2> = queries
            .into_iter()
            .map(|(x, y)| place(f64::from(x) / 125.0, f64::from(y) / 125.0))
            .collect();
        queries.extend(&made.points);
        // 2 x - 3 y relative to the center of the points, in units of the scale.
        let value = |p: Point2| {
            2.0 * (p[0] / scale - offset - 4.0) - 3.0 * (p[1] / scale - offset / 2.0 - 4.0)
        };
        let values: Vec<f64> = made.points.iter().map(|&p| value(p)).collect();
        let gradients: Vec<f64> = made
            .points
            .iter()
            .flat_map(|_| [2.0 / scale, -3.0 / scale])
            .collect();
        for (i, found) in made.values(&values, &gradients, &queries).into_iter().enumerate() {
            for (&q, z) in queries.iter().zip(found) {
                if made.is_inside(q) {
                    prop_assert!((z - value(q)).abs() < 1e-12, "{i}: {z} at {q:?}");
                } else {
                    prop_assert!(z.is_nan(), "{i}: {z} at {q:?}");
                }
            }
        }
    }

    #[test]
    fn values_at_the_sites_are_those_given(
        points in prop::collection::vec((0..9i32, 0..9i32), 4..50),
        scale in scale(),
    ) {
        let points: Vec<Point2> = points
            .into_iter()
            .map(|(x, y)| [f64::from(x) * scale, f64::from(y) * scale])
            .collect();
        let Some(made) = Made::of(points) else { return Ok(()) };
        let first = |p: &Point2| made.points.iter().position(|q| p == q).expect("itself");
        let odd = [-0.0, 0.1, f64::NAN, f64::INFINITY, 1e-320];
        let values: Vec<f64> = (0..made.points.len()).map(|i| odd[i % 5]).collect();
        let gradients = vec![f64::NAN; 2 * values.len()];
        for found in made.values(&values, &gradients, &made.points) {
            for (p, z) in made.points.iter().zip(found) {
                prop_assert_eq!(values[first(p)].to_bits(), z.to_bits());
            }
        }
    }

    #[test]
    fn leaving_one_out_equals_interpolating_the_others(
        points in prop::collection::vec((0..7i32, 0..7i32), 5..40),
    ) {
        let points = points.into_iter().map(|(x, y)| [f64::from(x), f64::from(y)]);
        let mut points: Vec<Point2> = points.collect();
        points.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
        points.dedup();
        let Some(made) = Made::of(points) else { return Ok(()) };
        let kinds = [Kind::Sibson, Kind::Laplace];
        for kind in kinds {
            let rows = leave_one_out(made.given(), Left::Natural(kind), 2, &Watch::idle());
            let rows = rows.expect("weights");
            for i in 0..made.points.len() {
                let mut others = made.points.clone();
                let q = others.remove(i);
                let Some(rest) = Made::of(others) else { continue };
                let row = rows.indptr[i] as usize..rows.indptr[i + 1] as usize;
                if !rest.is_inside(q) {
                    prop_assert!(row.is_empty());
                    continue;
                }
                let batch = Batch {
                    locator: Locator::new(rest.given(), &rest.kept, &IDLE),
                    queries: &[q],
                    workers: 1,
                    watch: &Watch::idle(),
                };
                let (expected, _) = natural(&batch, kind, &[]).expect("weights");
                let mut weights = vec![0.0; made.points.len()];
                for (&v, w) in rows.indices[row.clone()].iter().zip(&rows.weights[row]) {
                    weights[v as usize] += w;
                }
                for (&v, w) in expected.indices.iter().zip(&expected.weights) {
                    let v = v as usize + usize::from(v as usize >= i);
                    weights[v] -= w;
                }
                prop_assert!(weights.iter().all(|w| w.abs() < 1e-13), "{weights:?}");
            }
        }
    }
}

#[test]
fn a_barrier_excludes_values_beyond_it() {
    // Two rows of squares; the middle line is a barrier.
    let points: Vec<Point2> = (0..15)
        .map(|i| [f64::from(i % 5), f64::from(i / 5)])
        .collect();
    let made = Made::of(points).expect("squares");
    let is_middle = |v: i32| made.points[v as usize][1] == 1.0;
    let barrier: Vec<[bool; 3]> = made
        .simplices
        .iter()
        .map(|t| [0, 1, 2].map(|k| is_middle(t[(k + 1) % 3]) && is_middle(t[(k + 2) % 3])))
        .collect();
    let queries = [[1.3, 0.9], [2.5, 0.999], [2.5, 1.0], [2.2, 1.1]];
    let batch = Batch {
        locator: Locator::new(made.given(), &made.kept, &IDLE),
        queries: &queries,
        workers: 1,
        watch: &Watch::idle(),
    };
    for kind in [Kind::Sibson, Kind::Laplace] {
        let (open, _) = natural(&batch, kind, &[]).expect("weights");
        let (closed, _) = natural(&batch, kind, &barrier).expect("weights");
        let rows = |rows: &delone_core::interpolate::Rows, i: usize| -> Vec<f64> {
            let row = rows.indptr[i] as usize..rows.indptr[i + 1] as usize;
            let names = rows.indices[row].iter();
            names.map(|&v| made.points[v as usize][1]).collect()
        };
        assert!(rows(&open, 0).contains(&2.0));
        assert!(!rows(&closed, 0).contains(&2.0));
        assert!(!rows(&closed, 1).contains(&2.0));
        assert!(!rows(&closed, 3).contains(&0.0));
        // On the line: linear between the ends of the edge.
        let on_line = &closed.weights[closed.indptr[2] as usize..closed.indptr[3] as usize];
        assert_eq!(on_line, [0.5, 0.5]);
    }
}
