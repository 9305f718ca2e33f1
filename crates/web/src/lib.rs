//! The core in WebAssembly: flat arrays in, an `Answer` out. One thread.
//!
//! `js/delone.js` wraps these functions; nothing else calls them. No algorithm lives here.

mod answer;
mod domain;
mod live;
mod mesh;
mod plane;
mod signs;
mod space;
