// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One-pass connected-component labelling, one taxel a cycle in raster order: it counts components whose sum reaches
// `least`.
//
// Seeds that are neighbours along x or y are of one component. Its sum is that of |w|. The labels of the last row's
// taxels stand in a shift register, one step longer than a row. Each row ends with a step that is no seed. A taxel
// whose neighbours have two labels renames one to the other in the same cycle, everywhere in the register. A new label
// is the parity of its row and half its column. So each run of seeds has a label of its own in its row. The run gives
// it to the component above. The labels of a row are free again two rows later: any grid needs COLUMNS + 1 at most.
//
// A run of taxels adds its own and, where it joins another component, that one's sum. Between two runs a taxel passes
// that does not count, so that a sum is written before anything can join it. Sums only grow: one that reaches the
// least is one more, two of them that join are one less. From a taxel to the count: 4 cycles.

`default_nettype none

module sptfra_components #(
    // Taxels along x
    parameter COLUMNS = 10,
    // Bits of |w|, and of a sum, which has more
    parameter DATA_BITS = 27,
    parameter SUM_BITS = 34,
    // Bits of a label: the row, odd or even, and half the column
    parameter LABEL_WIDTH = 4
) (
    input  wire clock,
    input  wire clear, // a frame begins: no seed is above it
    input  wire [SUM_BITS-1:0] least, // held
    // Taxels, and a step without a seed at the end of each row
    input  wire step,
    input  wire seed,
    input  wire [LABEL_WIDTH-1:0] fresh, // label of a component that would begin here
    input  wire [DATA_BITS-1:0] weight, // a cycle later
    // Components whose sum reaches least: at most 12 have 5/64 of all
    output reg  [3:0] contacts
);

    // ---- Stage 1: the taxel's label. Seeds of the last row's steps, the newest in the lowest bits
    reg [COLUMNS:0] there;
    reg [LABEL_WIDTH*(COLUMNS+1)-1:0] labels;
    wire [LABEL_WIDTH-1:0] above = labels[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH];
    wire [LABEL_WIDTH-1:0] own = there[0] ? labels[LABEL_WIDTH-1:0] : fresh;
    wire meets = seed && there[COLUMNS] && (above != own);
    wire [LABEL_WIDTH*(COLUMNS+1)-1:0] renamed;
    // What the taxel is, a cycle later
    reg counts; // a seed,
    reg begins; // the first of a run,
    reg [LABEL_WIDTH-1:0] label;
    reg joins; // and it joins another component above,
    reg [LABEL_WIDTH-1:0] joined; // which had this label until now
    genvar index;

    for (index = 0; index <= COLUMNS; index = index + 1) begin : gen_labels
        wire [LABEL_WIDTH-1:0] old = labels[LABEL_WIDTH*index +: LABEL_WIDTH];

        assign renamed[LABEL_WIDTH*index +: LABEL_WIDTH] = (meets && (old == above)) ? own : old;
    end

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

    localparam [SUM_BITS-1:0] NOTHING = 0;

    // ---- Stage 2: the sum that is joined
    (* ram_style = "distributed" *) reg [SUM_BITS-1:0] sums [0:(1<<LABEL_WIDTH)-1];
    reg [SUM_BITS-1:0] joined_2;
    reg [DATA_BITS-1:0] weight_2;
    reg [LABEL_WIDTH-1:0] label_2;
    reg counts_2;
    reg begins_2;

    always @(posedge clock) begin
        joined_2 <= joins ? sums[joined] : NOTHING;
        weight_2 <= weight;
        label_2 <= label;
        counts_2 <= counts;
        begins_2 <= begins;
    end

    // ---- Stage 3: the sum of the run and of all that it has joined
    reg [SUM_BITS-1:0] sum;
    reg counts_3;
    reg begins_3;
    reg joined_contact_3;
    wire [SUM_BITS-1:0] grown = (begins_2 ? NOTHING : sum) + {{(SUM_BITS-DATA_BITS){1'b0}}, weight_2} + joined_2;

    always @(posedge clock) begin
        if (counts_2) begin
            sum <= grown;
            sums[label_2] <= grown;
        end
        counts_3 <= counts_2;
        begins_3 <= begins_2;
        joined_contact_3 <= (joined_2 >= least);
    end

    // ---- Stage 4: whether it is a contact, and was one
    reg was_contact;
    wire is_contact = (sum >= least);
    wire was_counted = was_contact && !begins_3;

    always @(posedge clock) begin
        if (counts_3) begin
            was_contact <= is_contact;
            contacts <= contacts + {3'd0, is_contact} - {3'd0, was_counted} - {3'd0, joined_contact_3};
        end
        if (clear) begin
            contacts <= 4'd0;
        end
    end

    wire _unused = &{1'b0, renamed[LABEL_WIDTH*COLUMNS +: LABEL_WIDTH]};

endmodule

`default_nettype wire
