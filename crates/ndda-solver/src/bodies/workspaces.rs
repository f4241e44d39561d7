//! Memory that congruent blocks work in, one run of them after the other.
//!
//! Apart from its nodes and what it [keeps](Kept), the step of a block reads nothing that it has not written itself. So where many blocks have one
//! shape, each thread has one set of working memory, which is lent to a run of these blocks for their step.

use std::mem::{replace, take};
use std::sync::{Mutex, MutexGuard};

use crate::bodies::batch::{Batch, ENOUGH_TOGETHER};
use crate::bodies::body::{Body, Motion};
use crate::bodies::elastic_body::{ElasticBody, Kept};
use crate::bodies::prototype::Prototype;

/// Blocks of one shape from which on they have no memory of their own.
pub(crate) const MANY: usize = 16;

/// Memory for blocks of one shape.
pub(crate) struct Workspaces {
    of_thread: Vec<Mutex<Workspace>>,
}

/// Memory for one run.
#[derive(Default)]
struct Workspace {
    #[allow(clippy::vec_box)] // they go from here into blocks and back as they are
    bodies: Vec<Box<ElasticBody>>,
    batch: Option<Box<Batch>>,
}

impl Workspaces {
    /// For the threads that there are now; more have to share.
    pub(crate) fn new() -> Self {
        Self { of_thread: (0..rayon::current_num_threads()).map(|_| Mutex::default()).collect() }
    }

    /// Makes blocks find memory for the factors that their shape has now.
    pub(crate) fn renew(&mut self) {
        self.of_thread.iter_mut().for_each(|workspace| *workspace = Mutex::default());
    }

    fn of_this_thread(&self) -> Option<MutexGuard<'_, Workspace>> {
        let thread = rayon::current_thread_index().unwrap_or(0) % self.of_thread.len();
        // A thread that waits inside a step for others may take up another run; that one brings memory of its own.
        self.of_thread[thread].try_lock().ok()
    }
}

/// A run of blocks, with memory to work in.
pub(crate) struct BorrowedRun<'a> {
    run: &'a mut [Body],
    workspace: Option<MutexGuard<'a, Workspace>>,
    /// Whether memory has to be given back.
    has_borrowed: bool,
}

impl<'a> BorrowedRun<'a> {
    /// Lends memory to those blocks of a run that have none of their own.
    pub(crate) fn new(shape: &Prototype, workspaces: Option<&'a Workspaces>, run: &'a mut [Body]) -> Self {
        let Some(workspaces) = workspaces else { return Self { run, workspace: None, has_borrowed: false } };
        let mut workspace = workspaces.of_this_thread();
        for body in run.iter_mut() {
            let Motion::Resting(kept) = &mut body.motion else { continue };
            let kept = take(kept);
            body.motion =
                Motion::Elastic(match workspace.as_mut().and_then(|workspace| workspace.bodies.pop()) {
                    Some(mut memory) => {
                        memory.kept = kept;
                        memory
                    }
                    None => Box::new(ElasticBody::new(shape, kept)),
                });
        }
        if let Some(factor) = shape.factor.as_deref().filter(|_| run.len() >= ENOUGH_TOGETHER) {
            let batch = workspace.as_mut().and_then(|workspace| workspace.batch.take());
            run[0].batch = Some(batch.unwrap_or_else(|| Box::new(Batch::new(factor))));
        }
        // Without the memory of the thread, what is made here is dropped in the end.
        Self { run, workspace, has_borrowed: true }
    }

    /// The blocks.
    pub(crate) fn run(&mut self) -> &mut [Body] {
        self.run
    }

    /// The only block of a run of one.
    pub(crate) fn one(&mut self) -> &mut Body {
        &mut self.run[0]
    }
}

impl Drop for BorrowedRun<'_> {
    fn drop(&mut self) {
        if !self.has_borrowed {
            return;
        }
        for body in self.run.iter_mut() {
            match replace(&mut body.motion, Motion::Resting(Kept::default())) {
                Motion::Elastic(mut memory) => {
                    body.motion = Motion::Resting(take(&mut memory.kept));
                    if let Some(workspace) = &mut self.workspace {
                        workspace.bodies.push(memory);
                    }
                }
                other => body.motion = other,
            }
        }
        let batch = self.run.first_mut().and_then(|first| first.batch.take());
        if let (Some(workspace), Some(batch)) = (&mut self.workspace, batch) {
            workspace.batch = Some(batch);
        }
    }
}
