//! How many contacts press, in integers: what `sptfra_contact_counter` finds of `|w|`.

use golden::contacts::Labels;

/// [`golden::contacts::SHARE`], which is over 64. Above this share of the largest `|w|` a taxel touches. From this share
/// of all `|w|` on a component is a contact.
pub(super) const SHARE: i64 = 5;
pub(super) const SHARE_OF: i64 = 64;

const _: () = assert!((golden::contacts::SHARE * SHARE_OF as f64) as i64 == SHARE);

/// Contacts by the steps of each taxel's `|w|` on a grid of `columns`, one at least. They are the components of touching
/// taxels that have a share of all.
pub fn count(weight: &[i64], columns: usize) -> u32 {
    let largest = weight.iter().copied().max().unwrap_or(0);
    let touched: Vec<bool> = weight.iter().map(|&weight| SHARE_OF * weight > SHARE * largest).collect();
    let mut labels = Labels::default();
    labels.find(&touched, columns);
    let mut sums = vec![0; labels.count];
    for (&component, &weight) in labels.components.iter().zip(weight) {
        if let Some(component) = component {
            sums[component] += weight;
        }
    }
    let all: i64 = weight.iter().sum();
    (sums.iter().filter(|&&sum| SHARE_OF * sum >= SHARE * all).count() as u32).max(1)
}
