stickslip completion fish | source
