//! What each reduction of the reduced plan saves: multiply-accumulates a frame and coefficients in ROM.

use golden::products::{ProductList, Step};
use serde::Serialize;

use super::Plan;
use super::product::Coefficients;

/// One step from the paper's plan to this one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Saving {
    /// The reduction.
    pub step: &'static str,
    /// Multiply-accumulates a frame from here on.
    pub macs: usize,
    /// Coefficients in ROM from here on.
    pub coefficients: usize,
}

/// The steps in the order in which they are taken; empty for the paper's plan.
pub fn savings(plan: &Plan) -> Vec<Saving> {
    let channels = plan.channels();
    if channels == 1 {
        return Vec::new();
    }
    let all = plan.taxels() * plan.taxels();
    let whole = |step: &'static str, list: &ProductList| {
        let is_stored = |step: &&Step| step.coefficients == Coefficients::Rom;
        let friction = list.steps.len() - list.steps.iter().filter(is_stored).count();
        let coefficients = (list.matrices.len() - friction) * all;
        Saving { step, macs: (list.steps.len() - friction) * all, coefficients }
    };
    let paper = ProductList::paper();
    let mut steps = vec![whole("the paper's plan", &paper), whole("fewer products", &paper.fewer_products(true))];
    if !plan.has_field() {
        steps.push(whole("resultants only", &paper.fewer_products(false)));
    }
    let of_products = || plan.products.iter().filter(|product| product.coefficients == Coefficients::Rom);
    let of_matrix = |index: usize| channels * plan.matrices[index].nnz();
    let block = channels * plan.elements() * plan.elements();
    let sums: usize =
        of_products().filter_map(|product| product.preload).map(|preload| of_matrix(preload.matrix)).sum();
    let whole = of_products().count() * block + sums;
    let kept = of_products().map(|product| of_matrix(product.matrix)).sum::<usize>() + sums;
    // The friction products have no coefficients of their own.
    let friction = plan.macs() as usize - kept;
    steps.push(Saving { step: "parity fold", macs: whole + friction, coefficients: whole });
    let mirrored = of_products().filter(|product| product.mirrored.is_some());
    let saved: usize = mirrored.map(|product| of_matrix(product.matrix)).sum();
    if saved > 0 {
        steps.push(Saving { step: "diagonal mirror", macs: whole + friction, coefficients: whole - saved });
    }
    if kept < whole {
        steps.push(Saving { step: "filter (not exact)", macs: kept + friction, coefficients: kept - saved });
    }
    steps
}
