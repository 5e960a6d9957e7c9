// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Tree of registers over a few numbers: their sum, or with LARGEST the largest of them, unsigned.
//
// Latency: the logarithm of their count, rounded up; of one number, none. Halves of more come a cycle before.

`default_nettype none

module sptfra_tree #(
    // Numbers
    parameter integer COUNT = 5,
    // Bits of a number and of the result; a sum wraps
    parameter integer WIDTH = 48,
    // 1: the largest number; 0: the sum
    parameter integer LARGEST = 0
) (
    input  wire clock,
    input  wire [WIDTH*COUNT-1:0] numbers,
    output wire [2*WIDTH-1:0] halves, // results of either half of the numbers; of one number, 0 and that
    output wire [WIDTH-1:0] result
);

    localparam integer LEAVES = 1 << $clog2(COUNT);

    genvar index;
    if (COUNT == 1) begin : gen_single
        assign halves = {{WIDTH{1'b0}}, numbers};
        assign result = numbers;

        wire _unused = clock;
    end else begin : gen_levels
        // Node 1 is the root; the children of node n are 2 n and 2 n + 1; nodes from LEAVES on are the numbers
        wire [WIDTH*LEAVES*2-1:0] nodes;

        for (index = LEAVES; index < 2 * LEAVES; index = index + 1) begin : gen_leaves
            if (index < LEAVES + COUNT) begin : gen_term
                assign nodes[WIDTH*index +: WIDTH] = numbers[WIDTH*(index - LEAVES) +: WIDTH];
            end else begin : gen_zero
                assign nodes[WIDTH*index +: WIDTH] = {WIDTH{1'b0}};
            end
        end
        for (index = 1; index < LEAVES; index = index + 1) begin : gen_tree
            wire [WIDTH-1:0] left = nodes[WIDTH*(2*index) +: WIDTH];
            wire [WIDTH-1:0] right = nodes[WIDTH*(2*index + 1) +: WIDTH];
            reg [WIDTH-1:0] node;

            always @(posedge clock) begin
                node <= (LARGEST == 0) ? left + right : (left > right) ? left : right;
            end

            assign nodes[WIDTH*index +: WIDTH] = node;
        end
        assign nodes[WIDTH-1:0] = {WIDTH{1'b0}};
        assign halves = nodes[WIDTH*2 +: 2*WIDTH];
        assign result = nodes[WIDTH +: WIDTH];

        wire _unused = &{1'b0, nodes[WIDTH-1:0]};
    end

endmodule

`default_nettype wire
