// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Sum of many terms by a tree of adders with a register behind each. Latency: a cycle for each level, that is the
// logarithm of COUNT; one sum a cycle. A single term passes at once.
//
// The two halves that the last adder adds are outputs too, a cycle before the sum, for what is decided beside it.

`default_nettype none

module sptfra_adder_tree #(
    // Terms
    parameter integer COUNT = 5,
    // Bits of a term and of the sum, which wraps
    parameter integer WIDTH = 48
) (
    input  wire clock,
    input  wire [WIDTH*COUNT-1:0] terms,
    output wire [WIDTH-1:0] left,
    output wire [WIDTH-1:0] right,
    output wire [WIDTH-1:0] sum
);

    localparam integer LEAVES = 1 << $clog2(COUNT);

    genvar index;
    generate
        if (COUNT == 1) begin : gen_single
            assign left = terms;
            assign right = {WIDTH{1'b0}};
            assign sum = terms;

            wire _unused = clock;
        end else begin : gen_levels
            // Node 1 is the root; the children of node n are 2 n and 2 n + 1; nodes from LEAVES on are the terms
            wire [WIDTH*LEAVES*2-1:0] nodes;

            for (index = LEAVES; index < 2 * LEAVES; index = index + 1) begin : gen_leaves
                if (index < LEAVES + COUNT) begin : gen_term
                    assign nodes[WIDTH*index +: WIDTH] = terms[WIDTH*(index - LEAVES) +: WIDTH];
                end else begin : gen_zero
                    assign nodes[WIDTH*index +: WIDTH] = {WIDTH{1'b0}};
                end
            end
            for (index = 1; index < LEAVES; index = index + 1) begin : gen_tree
                reg [WIDTH-1:0] node;

                always @(posedge clock) begin
                    node <= nodes[WIDTH*(2*index) +: WIDTH] + nodes[WIDTH*(2*index + 1) +: WIDTH];
                end

                assign nodes[WIDTH*index +: WIDTH] = node;
            end
            assign nodes[WIDTH-1:0] = {WIDTH{1'b0}};
            assign left = nodes[WIDTH*2 +: WIDTH];
            assign right = nodes[WIDTH*3 +: WIDTH];
            assign sum = nodes[WIDTH +: WIDTH];

            wire _unused = &{1'b0, nodes[WIDTH-1:0]};
        end
    endgenerate

endmodule

`default_nettype wire
