// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Sums of |w| over connected components, a taxel a cycle, and the count of components with the least sum.
//
// A run of taxels adds its own and, where it joins another component, that one's sum. Between two runs a taxel passes
// that does not count, so that a sum is written before anything can join it. Sums only grow: one that reaches the
// least is one more, two of them that join are one less. From a taxel to the count: 3 cycles.

`default_nettype none

module sptfra_component_sums #(
    // Bits of |w|, of a sum, and of a label
    parameter DATA_BITS = 27,
    parameter SUM_BITS = 34,
    parameter LABEL_WIDTH = 4
) (
    input  wire clock,
    input  wire clear, // a frame begins
    input  wire [SUM_BITS-1:0] least, // held
    // Taxels, from sptfra_component_labels
    input  wire counts,
    input  wire begins,
    input  wire [LABEL_WIDTH-1:0] label,
    input  wire joins,
    input  wire [LABEL_WIDTH-1:0] joined,
    input  wire [DATA_BITS-1:0] weight,
    // Components with the least sum: at most 12 have 5/64 of all
    output reg  [3:0] contacts
);

    generate
        if (SUM_BITS <= DATA_BITS) begin : gen_check_sum
            sptfra_error_sums_must_be_wider_than_weights invalid ();
        end
    endgenerate

    localparam [SUM_BITS-1:0] NOTHING = 0;

    // ---- Stage 1: the sum that is joined
    (* ram_style = "distributed" *) reg [SUM_BITS-1:0] sums [0:(1<<LABEL_WIDTH)-1];
    reg [SUM_BITS-1:0] joined_1;
    reg [DATA_BITS-1:0] weight_1;
    reg [LABEL_WIDTH-1:0] label_1;
    reg counts_1;
    reg begins_1;

    always @(posedge clock) begin
        joined_1 <= joins ? sums[joined] : NOTHING;
        weight_1 <= weight;
        label_1 <= label;
        counts_1 <= counts;
        begins_1 <= begins;
    end

    // ---- Stage 2: the sum of the run and of all that it has joined
    reg [SUM_BITS-1:0] sum;
    reg counts_2;
    reg begins_2;
    reg joined_contact_2;
    wire [SUM_BITS-1:0] grown = (begins_1 ? NOTHING : sum) + {{(SUM_BITS-DATA_BITS){1'b0}}, weight_1} + joined_1;

    always @(posedge clock) begin
        if (counts_1) begin
            sum <= grown;
            sums[label_1] <= grown;
        end
        counts_2 <= counts_1;
        begins_2 <= begins_1;
        joined_contact_2 <= (joined_1 >= least);
    end

    // ---- Stage 3: whether it is a contact, and was one
    reg was_contact;
    wire is_contact = (sum >= least);
    wire was_counted = was_contact && !begins_2;

    always @(posedge clock) begin
        if (counts_2) begin
            was_contact <= is_contact;
            contacts <= contacts + {3'd0, is_contact} - {3'd0, was_counted} - {3'd0, joined_contact_2};
        end
        if (clear) begin
            contacts <= 4'd0;
        end
    end

endmodule

`default_nettype wire
