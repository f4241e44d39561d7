//! How the surfaces of blocks that deform give way to contact within a step.

use ndda_mesh::{BlockId, Vec3};

use crate::model::{ContactInput, Deformation};
use crate::restitution::ContactDamping;
use crate::restitution::scene::DampingScene;

impl ContactDamping {
    /// How the surfaces of blocks that deform give way to the pushes of pairs within the step; then the rates of all points.
    pub(super) fn ask_blocks(&mut self, scene: &DampingScene) {
        let ContactInput { bodies, dt_s, blocks, deformation, .. } = *scene.input;
        self.columns.resize_with(bodies.len(), Vec::new);
        self.columns.iter_mut().for_each(Vec::clear);
        let deformation = deformation.filter(|_| !self.pairs.is_empty());
        if let Some(deformation) = deformation {
            for pair in &self.pairs {
                for block in pair.blocks.iter().filter(|block| bodies[block.index()].deforms) {
                    let (nodes, column) = (blocks.nodes_of(*block), &mut self.columns[block.index()]);
                    // The first column is the block's own motion.
                    column.resize(column.len().max(nodes.len()) + nodes.len(), Vec3::zeros());
                    let own = column.len() - nodes.len();
                    for four in self.points[pair.range()].chunks_exact(4) {
                        let share = 4.0 * four[0].force_n / pair.total_n;
                        scene.each_weight(four[0].facet, *block, |node, weight| {
                            column[own + node - nodes.start] += share * weight * four[0].push;
                        });
                    }
                }
            }
            self.answer(deformation);
        }
        self.asked.clear();
        self.asked.resize(bodies.len(), 1);
        for pair in &mut self.pairs {
            let mut softness = 0.0;
            for block in pair.blocks.iter().filter(|block| bodies[block.index()].deforms) {
                if deformation.is_none() {
                    continue;
                }
                let nodes = blocks.nodes_of(*block);
                let number = &mut self.asked[block.index()];
                let answer = &self.columns[block.index()][*number * nodes.len()..];
                *number += 1;
                let mut along = 0.0;
                for four in self.points[pair.range()].chunks_exact(4) {
                    let share = 4.0 * four[0].force_n / pair.total_n;
                    scene.each_weight(four[0].facet, *block, |node, weight| {
                        along += share * weight * four[0].push.dot(&answer[node - nodes.start]);
                    });
                }
                let rigid = pair.rigid_response(&bodies[block.index()], dt_s);
                softness += (along - rigid).max(0.0);
            }
            pair.softness = softness;
            pair.set_rates(&mut self.points[pair.range()], dt_s, |_| 0.0);
        }
    }

    /// Lets the blocks answer that have columns.
    fn answer(&mut self, deformation: &dyn Deformation) {
        let Self { columns, answering, answers, .. } = self;
        answering.clear();
        answers.clear();
        for (block, column) in (0..).map(BlockId).zip(&mut *columns).filter(|(_, column)| !column.is_empty())
        {
            answering.push(block);
            answers.push(std::mem::take(column));
        }
        deformation.answer(answering, answers);
        for (block, answer) in answering.iter().zip(answers) {
            columns[block.index()] = std::mem::take(answer);
        }
    }
}
