//! Node-to-segment contact: pairs, their rows and their complementarity problem.
