// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Largest of a few unsigned numbers: a tree of registers.
//
// Latency: the logarithm of their count; of one number, none.

`default_nettype none

module sptfra_largest #(
    // Numbers, a power of two, and their bits
    parameter COUNT = 4,
    parameter WIDTH = 27
) (
    input  wire clock,
    input  wire [COUNT*WIDTH-1:0] numbers,
    output wire [WIDTH-1:0] largest
);

    // Node n has the nodes 2n and 2n + 1 below it
    wire [WIDTH-1:0] nodes [1:2*COUNT-1];
    genvar node;

    assign largest = nodes[1];

    generate
        for (node = 1; node < 2 * COUNT; node = node + 1) begin : gen_nodes
            if (node >= COUNT) begin : gen_leaf
                assign nodes[node] = numbers[WIDTH*(node-COUNT) +: WIDTH];
            end else begin : gen_pair
                reg [WIDTH-1:0] larger;

                assign nodes[node] = larger;

                always @(posedge clock) begin
                    larger <= (nodes[2*node] > nodes[2*node+1]) ? nodes[2*node] : nodes[2*node+1];
                end
            end
        end
        if (COUNT == 1) begin : gen_single
            wire _unused = &{1'b0, clock};
        end
    endgenerate

endmodule

`default_nettype wire
