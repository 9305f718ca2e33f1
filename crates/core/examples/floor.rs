//! What an insertion in 2-D costs at least on this machine:
//! `cargo run --release -p delone-core --example floor -- 1000000 5`, nanoseconds per point.
//!
//! The loop is that of `delaunay::plane::cavity`, in blocks as there, without exact predicates. The
//! first run writes a tape: in which triangle each insertion starts, and the outcome of each in-circle
//! test. The other runs take from the tape what they leave out, and make the same triangles:
//!
//! - *whole*: everything, as the library does it;
//! - *no walk*: the first triangle is known, as if keys were so fine that no walk is left;
//! - *no wait*: outcomes are known, too; tests are computed, but no branch waits for them;
//! - *bare*: only loads of codes and vertices, one branch for each outcome, and the writes of the star;
//! - *writes*: only the writes, from lists of records: no branch depends on data.
//!
//! One mode, as in `floor 100000 2 bare`, makes a profile:
//! `valgrind --tool=cachegrind --branch-sim=yes`.

use std::hint::black_box;
use std::time::Instant;

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::mesh::plane::{Code, Mesh2, Patch, half_edge, next, prev, triangle};
use delone_core::order::{Rounds, arrange};

const MODES: [&str; 5] = ["whole", "no walk", "no wait", "bare", "writes"];
/// Of the in-circle filter, as in the library.
const BOUND: f64 = 8.0 * f64::EPSILON;
const STRIDES: [u32; 3] = [64, 8, 1];

/// What the first run finds out.
#[derive(Default)]
struct Tape {
    seeds: Vec<Code>,
    outcomes: Vec<bool>,
    /// Of each insertion the number of new triangles; of each triangle its record and corners, and
    /// the codes across.
    stars: Vec<u32>,
    writes: Vec<[u32; 7]>,
}

/// A vertex as seen from the new point.
#[derive(Clone, Copy, Default)]
struct Ray {
    vertex: u32,
    d: Point2,
    lift: f64,
}

/// An edge of the boundary so far.
#[derive(Clone, Copy)]
struct Rim {
    across: Code,
    end: Ray,
    cross: f64,
    apex: Ray,
}

struct Kernel<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    rim: Vec<Rim>,
    free: Vec<u32>,
    tape: &'a mut Tape,
    insertion: usize,
    outcome: usize,
    sum: f64,
}

fn cross(a: Point2, b: Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

const WHOLE: u8 = 0;
const NO_WALK: u8 = 1;
const NO_WAIT: u8 = 2;
const BARE: u8 = 3;
const TAPED: u8 = 9;

impl Kernel<'_> {
    #[inline(always)]
    fn ray<const MODE: u8>(&self, vertex: u32, origin: Point2) -> Ray {
        if MODE == BARE {
            return Ray {
                vertex,
                ..Ray::default()
            };
        }
        let p = self.points[vertex as usize];
        let d = [p[0] - origin[0], p[1] - origin[1]];
        let lift = d[0] * d[0] + d[1] * d[1];
        Ray { vertex, d, lift }
    }

    #[inline(always)]
    fn rim<const MODE: u8>(&self, across: Code, end: Ray, cross: f64, origin: Point2) -> Rim {
        let apex = self.ray::<MODE>(self.mesh.vertex(across), origin);
        Rim {
            across,
            end,
            cross,
            apex,
        }
    }

    /// Inserts `p` and returns the triangle toward `aim`, if a walk will need it.
    #[inline(always)]
    fn insert<const MODE: u8>(&mut self, p: u32, near: u32, aim: Point2) -> u32 {
        let origin = self.points[p as usize];
        let aim = [aim[0] - origin[0], aim[1] - origin[1]];
        let walks = MODE == WHOLE || MODE == TAPED;
        let e = if walks {
            self.walk(origin, near)
        } else {
            self.tape.seeds[self.insertion]
        };
        if MODE == TAPED {
            self.tape.seeds.push(e);
        }
        self.insertion += 1;
        let corner = |e: Code| self.ray::<MODE>(self.mesh.vertex(e), origin);
        let [a, b, c] = [corner(e), corner(next(e)), corner(prev(e))];
        let [bc, ca, ab] = [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)];
        self.rim.clear();
        self.free.clear();
        let spare = [self.mesh.fresh(), self.mesh.fresh()];
        self.free.extend_from_slice(&spare);
        self.free.push(triangle(e));
        let last_edge = self.rim::<MODE>(self.mesh.opposite(next(e)), a, ca, origin);
        self.rim.push(last_edge);
        let middle = self.rim::<MODE>(self.mesh.opposite(e), c, bc, origin);
        self.rim.push(middle);
        let mut edge = self.rim::<MODE>(self.mesh.opposite(prev(e)), b, ab, origin);
        let mut from = a;
        let mut side = cross(a.d, aim);
        let (mut first, mut last, mut hint) = (u32::MAX, u32::MAX, u32::MAX);
        let start = self.tape.writes.len();
        loop {
            let apex = edge.apex;
            let (mut right, mut left) = (0.0, 0.0);
            let mut conflict = false;
            if MODE != BARE {
                right = cross(from.d, apex.d);
                left = cross(apex.d, edge.end.d);
                let (u, v, w) = (from.lift, edge.end.lift, apex.lift);
                let det = v * right + u * left - w * edge.cross;
                let bound = BOUND * (u * v + w * (u + v));
                if MODE == NO_WAIT {
                    self.sum += det - bound;
                } else {
                    conflict = if det.abs() > bound {
                        det > 0.0
                    } else {
                        self.conflicts([from, edge.end, apex], det)
                    };
                }
            }
            if MODE == NO_WAIT || MODE == BARE {
                conflict = self.tape.outcomes[self.outcome];
                self.outcome += 1;
            } else if MODE == TAPED {
                self.tape.outcomes.push(conflict);
            }
            if conflict {
                let e = edge.across;
                self.free.push(triangle(e));
                let beyond = [self.mesh.opposite(prev(e)), self.mesh.opposite(next(e))];
                let second = self.rim::<MODE>(beyond[0], edge.end, left, origin);
                self.rim.push(second);
                edge = self.rim::<MODE>(beyond[1], apex, right, origin);
                continue;
            }
            let t = self.free.pop().unwrap_or_default();
            self.mesh.set(t, [p, from.vertex, edge.end.vertex]);
            self.mesh.link(edge.across, half_edge(t, 0));
            if MODE == TAPED {
                let write = [t, p, from.vertex, edge.end.vertex, edge.across, 0, 0];
                self.tape.writes.push(write);
            }
            if last == u32::MAX {
                first = t;
            } else {
                self.mesh.link(half_edge(last, 1), half_edge(t, 2));
            }
            last = t;
            if walks {
                let ahead = cross(edge.end.d, aim);
                let toward = side >= 0.0 && (ahead < 0.0 || ahead.is_nan());
                hint = if toward { t } else { hint };
                side = ahead;
            }
            from = edge.end;
            match self.rim.pop() {
                Some(rim) => edge = rim,
                None => break,
            }
        }
        self.mesh.link(half_edge(last, 1), half_edge(first, 2));
        if MODE == TAPED {
            let star = &mut self.tape.writes[start..];
            let k = star.len();
            for i in 0..k {
                star[i][5] = star[(i + 1) % k][0];
                star[i][6] = star[(i + k - 1) % k][0];
            }
            self.tape.stars.push(k as u32);
        }
        if hint == u32::MAX { last } else { hint }
    }

    /// A half-edge of a triangle in conflict, reached from `near`.
    #[inline(always)]
    fn walk(&mut self, origin: Point2, near: u32) -> Code {
        let mut e = half_edge(near, 0);
        let [mut a, mut b, mut c] = self
            .mesh
            .corners(near)
            .map(|v| self.ray::<WHOLE>(v, origin));
        for _ in 0..1 << 20 {
            let [bc, ca, ab] = [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)];
            let det = a.lift * bc + b.lift * ca + c.lift * ab;
            let sum = a.lift + b.lift;
            if det > BOUND * (a.lift * b.lift + c.lift * sum) {
                return e;
            }
            // A ghost has NaN here; it is in conflict if the point is beyond its hull edge.
            if bc < 0.0 {
                (b, c) = (c, b);
            } else if ca < 0.0 {
                e = next(e);
                (b, c) = (a, c);
            } else if ab < 0.0 {
                e = prev(e);
                (b, c) = (b, a);
            } else {
                return e;
            }
            e = self.mesh.opposite(e);
            a = self.ray::<WHOLE>(self.mesh.vertex(e), origin);
        }
        e
    }

    /// The same decision for ghosts.
    #[cold]
    #[inline(never)]
    fn conflicts(&self, [u, v, w]: [Ray; 3], det: f64) -> bool {
        let infinite = self.mesh.infinite();
        match [u.vertex, v.vertex, w.vertex].map(|x| x == infinite) {
            [true, ..] => cross(w.d, v.d) > 0.0,
            [_, true, _] => cross(u.d, w.d) > 0.0,
            [_, _, true] => cross(v.d, u.d) > 0.0,
            _ => det > 0.0,
        }
    }

    /// The writes of an insertion, from the tape.
    #[inline(always)]
    fn write(&mut self) {
        self.mesh.fresh();
        self.mesh.fresh();
        let k = self.tape.stars[self.insertion] as usize;
        self.insertion += 1;
        for &[t, p, u, v, across, left, right] in &self.tape.writes[self.outcome..][..k] {
            *self.mesh.record_mut(t) = [
                p,
                u,
                v,
                0,
                across,
                half_edge(left, 2),
                half_edge(right, 1),
                0,
            ];
            self.mesh.set_opposite(across, half_edge(t, 0));
        }
        self.outcome += k;
    }
}

/// A block of points, the last of which is infinite, and its tape.
struct Block {
    points: Vec<Point2>,
    tape: Tape,
    mesh: Mesh2,
}

impl Block {
    /// One run; returns seconds.
    fn run(&mut self, mode: Option<usize>) -> f64 {
        let n = self.points.len() as u32 - 1;
        let start = Instant::now();
        let mut mesh = self.mesh.patch();
        let first = [0, 64, 128];
        let [a, b, c] = first.map(|v| self.points[v as usize]);
        let turn = cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let corners = if turn > 0.0 { first } else { [0, 128, 64] };
        let ghost = mesh.triangle(corners);
        let mut kernel = Kernel {
            points: &self.points,
            mesh,
            rim: Vec::new(),
            free: Vec::new(),
            tape: &mut self.tape,
            insertion: 0,
            outcome: 0,
            sum: 0.0,
        };
        let mut order = Rounds::over(n, STRIDES).filter(|v| !first.contains(v));
        let mut near = triangle(ghost);
        let mut following = order.next();
        while let Some(p) = following {
            following = order.next();
            let aim = kernel.points[following.unwrap_or(p) as usize];
            match mode {
                None => near = kernel.insert::<TAPED>(p, near, aim),
                Some(0) => near = kernel.insert::<WHOLE>(p, near, aim),
                Some(1) => near = kernel.insert::<NO_WALK>(p, near, aim),
                Some(2) => near = kernel.insert::<NO_WAIT>(p, near, aim),
                Some(3) => near = kernel.insert::<BARE>(p, near, aim),
                _ => kernel.write(),
            }
        }
        black_box(kernel.sum);
        start.elapsed().as_secs_f64()
    }

    /// The triangles, each from its smallest corner, in order.
    fn triangles(&mut self) -> Vec<[u32; 3]> {
        let n = self.points.len() as u32 - 1;
        let patch = self.mesh.patch();
        let mut all: Vec<[u32; 3]> = (0..2 * n - 2)
            .map(|t| {
                let mut corners = patch.corners(t);
                let least = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
                corners.rotate_left(least);
                corners
            })
            .collect();
        all.sort_unstable();
        all
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, other| {
        arguments
            .get(i)
            .and_then(|a| a.parse().ok())
            .unwrap_or(other)
    };
    let (n, runs) = (number(0, 1_000_000), number(1, 5));
    let only = arguments
        .get(2..)
        .map(|words| words.join(" "))
        .filter(|w| !w.is_empty());
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut random = move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    };
    let points: Vec<Point2> = (0..n).map(|_| [random(), random()]).collect();
    let arranged = arrange(&points, 1, &Watch::idle()).expect("an order");
    let mut blocks: Vec<Block> = arranged
        .starts
        .windows(2)
        .map(|w| {
            let mut points = arranged.points[w[0]..w[1]].to_vec();
            let mesh = Mesh2::with_vertices(points.len()).expect("a mesh");
            points.push([f64::NAN; 2]);
            Block {
                points,
                tape: Tape::default(),
                mesh,
            }
        })
        .collect();
    let mut expected = Vec::new();
    for block in &mut blocks {
        block.run(None);
        expected.push(block.triangles());
    }
    let tests: usize = blocks.iter().map(|b| b.tape.outcomes.len()).sum();
    println!(
        "{n} points, {:.2} in-circle tests per point",
        tests as f64 / n as f64
    );
    let chosen = |i: &usize| only.as_ref().is_none_or(|name| name == MODES[*i]);
    let modes: Vec<usize> = (0..MODES.len()).filter(chosen).collect();
    let mut times = vec![Vec::new(); MODES.len()];
    for run in 0..runs {
        for &mode in &modes {
            times[mode].push(blocks.iter_mut().map(|b| b.run(Some(mode))).sum::<f64>());
            if run == 0 && only.is_none() {
                let same = blocks
                    .iter_mut()
                    .zip(&expected)
                    .all(|(b, e)| b.triangles() == *e);
                assert!(same, "{} makes other triangles", MODES[mode]);
            }
        }
    }
    for mode in modes {
        times[mode].sort_by(f64::total_cmp);
        let each = |s: f64| s * 1e9 / n as f64;
        let (median, least) = (each(times[mode][runs / 2]), each(times[mode][0]));
        println!("{:8} {median:6.1} ({least:5.1}) ns per point", MODES[mode]);
    }
}
