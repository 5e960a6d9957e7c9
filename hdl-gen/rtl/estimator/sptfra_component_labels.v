// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One-pass connected-component labelling, one taxel a cycle in raster order: seeds that are neighbours along x or y.
//
// The labels of the last row's taxels stand in a shift register, one step longer than a row: each row ends with a step
// that is no seed. A taxel whose neighbours have two labels renames one to the other in the same cycle, everywhere in
// the register. A new label is the parity of its row and half its column, so that each run of seeds has a label of its
// own in its row. The run gives it to the component above, and the labels of a row are free again two rows later: for
// any grid there are no more than COLUMNS + 1 of them.
//
// Latency from a taxel to its label: 1 cycle.

`default_nettype none

module sptfra_component_labels #(
    // Taxels along x
    parameter COLUMNS = 10,
    // Derived
    parameter LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2
) (
    input  wire clock,
    input  wire clear, // a frame begins: no seed is above it
    // Taxels, and a step without a seed at the end of each row
    input  wire step,
    input  wire seed,
    input  wire [LABEL_WIDTH-1:0] fresh, // label of a component that would begin here
    // What the taxel is
    output reg  counts, // it is a seed,
    output reg  begins, // the first of a run,
    output reg  [LABEL_WIDTH-1:0] label,
    output reg  joins, // and it joins another component above,
    output reg  [LABEL_WIDTH-1:0] joined // which had this label until now
);

    generate
        if ((COLUMNS < 2) || (COLUMNS > 64)) begin : gen_check_columns
            sptfra_error_columns_must_be_2_to_64 invalid ();
        end
    endgenerate

    // ---- Seeds of the last row's steps, the newest in the lowest bits
    reg [COLUMNS:0] there;
    reg [LABEL_WIDTH*(COLUMNS+1)-1:0] labels;
    wire [LABEL_WIDTH-1:0] above = labels[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH];
    wire [LABEL_WIDTH-1:0] own = there[0] ? labels[LABEL_WIDTH-1:0] : fresh;
    wire meets = seed && there[COLUMNS] && (above != own);
    wire [LABEL_WIDTH*(COLUMNS+1)-1:0] renamed;
    genvar index;

    generate
        for (index = 0; index <= COLUMNS; index = index + 1) begin : gen_labels
            wire [LABEL_WIDTH-1:0] old = labels[LABEL_WIDTH*index +: LABEL_WIDTH];

            assign renamed[LABEL_WIDTH*index +: LABEL_WIDTH] = (meets && (old == above)) ? own : old;
        end
    endgenerate

    always @(posedge clock) begin
        if (step) begin
            there <= {there[COLUMNS-1:0], seed};
            labels <= {renamed[LABEL_WIDTH*COLUMNS-1:0], own};
        end
        if (clear) begin
            there <= {(COLUMNS+1){1'b0}};
        end
        counts <= step && seed;
        begins <= !there[0];
        label <= own;
        joins <= meets;
        joined <= above;
    end

    wire _unused = &{1'b0, renamed[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH]};

endmodule

`default_nettype wire
