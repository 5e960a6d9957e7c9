//! The sums of a frame from which its forces and torques are made.

/// The sums `G_pq` by `[p - 1][q]`, so that `F_p = G_p0 + mu_x G_p1 + mu_y G_p2`, and after those of `F_x`, `F_y` and
/// `F_z` in the same form those of the torques `T_x`, `T_y` and `T_z` about the middle of the grid.
pub type ByPq<T> = [[T; 3]; RESULTANTS];
/// Forces and torques of a frame.
pub const RESULTANTS: usize = 6;
