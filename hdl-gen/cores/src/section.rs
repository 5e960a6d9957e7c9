//! Takes a kernel apart into sections, wires, and what belongs to a clocked process.
//!
//! A comment of the kernel opens a section. Sections that assign the same register share a clocked process, at the last
//! of them.

use std::collections::{BTreeMap, BTreeSet};

use rust_hdl_core::ast::{
    VerilogBlockOrConditional as Otherwise, VerilogCase, VerilogConditional, VerilogExpression as Expression,
    VerilogMatch, VerilogOpUnary, VerilogStatement as Statement,
};

use crate::flow::driven;

/// What stands under one comment.
#[derive(Default)]
pub(super) struct Section {
    pub(super) comment: Vec<String>,
    pub(super) body: Vec<Statement>,
    /// Whether the comment has been printed.
    pub(super) told: bool,
}

/// Whether a driven signal is what a register takes.
pub(super) fn is_register(name: &str) -> bool {
    name.ends_with("$d")
}

/// The kernel, cut at its comments, without the registers' defaults of holding.
pub(super) fn sections(kernel: Vec<Statement>) -> Result<Vec<Section>, String> {
    let mut sections = vec![Section::default()];
    let mut assigned = BTreeSet::new();
    for statement in kernel {
        if let Statement::Comment(words) = &statement {
            match sections.last_mut().filter(|section| section.body.is_empty() && !section.comment.is_empty()) {
                Some(section) => section.comment.push(words.clone()),
                None => sections.push(Section { comment: vec![words.clone()], ..Section::default() }),
            }
            continue;
        }
        let mut names = Vec::new();
        targets(std::slice::from_ref(&statement), &mut names)?;
        let holds = matches!(&statement, Statement::Assignment(_, Expression::Signal(value))
            if names[0].strip_suffix("$d").is_some_and(|register| value.strip_suffix("$q") == Some(register)));
        let first = names.iter().all(|name| !assigned.contains(name));
        assigned.extend(names);
        if !(holds && first)
            && let Some(section) = sections.last_mut()
        {
            section.body.push(statement);
        }
    }
    Ok(sections)
}

/// Everything that statements assign, once an assignment.
fn targets(block: &[Statement], names: &mut Vec<String>) -> Result<(), String> {
    for statement in block {
        match statement {
            Statement::If(choice) => {
                targets(&choice.then, names)?;
                match &choice.otherwise {
                    Otherwise::Block(block) => targets(block, names)?,
                    Otherwise::Conditional(next) => targets(std::slice::from_ref(next), names)?,
                    Otherwise::None => {}
                }
            }
            Statement::Match(choice) => choice.cases.iter().try_for_each(|case| targets(&case.block, names))?,
            _ => names.push(driven(statement).ok_or("a comment stands within a condition")?.to_owned()),
        }
    }
    Ok(())
}

/// Signals with one assignment, and that without a condition.
pub(super) fn wires(sections: &[Section]) -> Result<BTreeSet<String>, String> {
    let mut assignments = BTreeMap::<String, usize>::new();
    let mut home = BTreeMap::new();
    for (index, section) in sections.iter().enumerate() {
        let mut names = Vec::new();
        targets(&section.body, &mut names)?;
        for name in names.into_iter().filter(|name| !is_register(name)) {
            if *home.entry(name.clone()).or_insert(index) != index {
                return Err(format!("`{name}` is assigned under two comments"));
            }
            *assignments.entry(name).or_default() += 1;
        }
    }
    let plain = sections.iter().flat_map(|section| &section.body).filter_map(driven);
    Ok(plain.filter(|name| assignments.get(*name) == Some(&1)).map(str::to_owned).collect())
}

/// The sections of each clocked process, by the last of them: those that assign a register in common.
pub(super) fn clocked(sections: &[Section]) -> BTreeMap<usize, Vec<usize>> {
    let mut groups: Vec<(BTreeSet<String>, Vec<usize>)> = Vec::new();
    for (index, section) in sections.iter().enumerate() {
        let mut names = Vec::new();
        // Checked by `wires` before.
        let _ = targets(&section.body, &mut names);
        let mut registers: BTreeSet<String> = names.into_iter().filter(|name| is_register(name)).collect();
        if registers.is_empty() {
            continue;
        }
        let mut members = Vec::new();
        groups.retain(|(others, indices)| {
            let apart = registers.is_disjoint(others);
            if !apart {
                registers.extend(others.iter().cloned());
                members.extend(indices);
            }
            apart
        });
        members.push(index);
        members.sort_unstable();
        groups.push((registers, members));
    }
    groups.into_iter().filter_map(|(_, members)| Some((*members.last()?, members))).collect()
}

/// The statements without those that assign anything else, and without the conditions that decide nothing then.
pub(super) fn kept(block: &[Statement], wanted: &dyn Fn(&str) -> bool) -> Vec<Statement> {
    block.iter().filter_map(|statement| keep(statement, wanted)).collect()
}

fn keep(statement: &Statement, wanted: &dyn Fn(&str) -> bool) -> Option<Statement> {
    match statement {
        Statement::If(choice) => {
            let then = kept(&choice.then, wanted);
            let otherwise = match &choice.otherwise {
                Otherwise::Block(block) => {
                    Some(kept(block, wanted)).filter(|block| !block.is_empty()).map(Otherwise::Block)
                }
                Otherwise::Conditional(next) => keep(next, wanted).map(|next| Otherwise::Conditional(Box::new(next))),
                Otherwise::None => None,
            };
            let test = choice.test.clone();
            match otherwise {
                None if then.is_empty() => None,
                Some(otherwise) if then.is_empty() => {
                    let test = Expression::Unary(VerilogOpUnary::Not, Box::new(test));
                    let then = match otherwise {
                        Otherwise::Block(block) => block,
                        Otherwise::Conditional(next) => vec![*next],
                        Otherwise::None => Vec::new(),
                    };
                    Some(Statement::If(VerilogConditional { test, then, otherwise: Otherwise::None }))
                }
                otherwise => {
                    let otherwise = otherwise.unwrap_or(Otherwise::None);
                    Some(Statement::If(VerilogConditional { test, then, otherwise }))
                }
            }
        }
        Statement::Match(choice) => {
            let cases: Vec<VerilogCase> = choice
                .cases
                .iter()
                .map(|case| VerilogCase { condition: case.condition.clone(), block: kept(&case.block, wanted) })
                .collect();
            let any = cases.iter().any(|case| !case.block.is_empty());
            any.then(|| Statement::Match(VerilogMatch { test: choice.test.clone(), cases }))
        }
        _ => driven(statement).filter(|name| wanted(name)).map(|_| statement.clone()),
    }
}
