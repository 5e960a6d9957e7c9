// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The blobs with the largest sums, largest first; of equal ones that which came first.
//
// A blob may come every other cycle. From the cycle of its taxels and its body, one behind its sum, to its place: 1.

`default_nettype none

module sptfra_regions_largest #(
    // Places
    parameter CONTACTS = 4,
    // Bits of a sum and of a number of taxels
    parameter SUM_BITS = 33,
    parameter COUNT_BITS = 8
) (
    input  wire clock,
    input  wire clear, // a frame begins
    // Blobs
    input  wire [SUM_BITS-1:0] sum, // above 0
    input  wire begins, // a cycle later, with
    input  wire [COUNT_BITS-1:0] taxels,
    input  wire [3:0] body, // 15: it is none
    // The places, the first in the lowest bits: taxels, and whose
    output wire [CONTACTS*16-1:0] all_taxels,
    output reg  [CONTACTS*4-1:0] all_bodies
);

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8)) begin : gen_check_contacts
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
    endgenerate

    localparam [3:0] NONE = 4'd15;

    reg [SUM_BITS-1:0] sum_1;
    reg [CONTACTS*SUM_BITS-1:0] sums;
    reg [CONTACTS*COUNT_BITS-1:0] counts;
    reg [CONTACTS-1:0] above; // the new one's sum, of each place
    genvar place;

    always @(posedge clock) begin
        sum_1 <= sum;
    end

    generate
        for (place = 0; place < CONTACTS; place = place + 1) begin : gen_places
            wire [SUM_BITS-1:0] own_sum = sums[SUM_BITS*place +: SUM_BITS];
            wire [COUNT_BITS-1:0] own_count = counts[COUNT_BITS*place +: COUNT_BITS];
            // What comes in its place: the one before it, if that has to leave its own, too
            wire [SUM_BITS-1:0] next_sum;
            wire [COUNT_BITS-1:0] next_count;
            wire [3:0] next_body;

            if (place == 0) begin : gen_first
                assign next_sum = sum_1;
                assign next_count = taxels;
                assign next_body = body;
                // A blob alone is a body, however small its share
                assign all_taxels[15:0] = {{(16-COUNT_BITS){1'b0}}, own_count};
            end else begin : gen_others
                wire moves = above[place-1];
                wire is_body = (all_bodies[4*place +: 4] != NONE);

                assign next_sum = moves ? sums[SUM_BITS*(place-1) +: SUM_BITS] : sum_1;
                assign next_count = moves ? counts[COUNT_BITS*(place-1) +: COUNT_BITS] : taxels;
                assign next_body = moves ? all_bodies[4*(place-1) +: 4] : body;
                assign all_taxels[16*place +: 16] = is_body ? {{(16-COUNT_BITS){1'b0}}, own_count} : 16'd0;
            end

            always @(posedge clock) begin
                above[place] <= (sum > own_sum);
                if (begins && above[place]) begin
                    sums[SUM_BITS*place +: SUM_BITS] <= next_sum;
                    counts[COUNT_BITS*place +: COUNT_BITS] <= next_count;
                    all_bodies[4*place +: 4] <= next_body;
                end
                if (clear) begin
                    sums[SUM_BITS*place +: SUM_BITS] <= {SUM_BITS{1'b0}};
                    counts[COUNT_BITS*place +: COUNT_BITS] <= {COUNT_BITS{1'b0}};
                    all_bodies[4*place +: 4] <= NONE;
                end
            end
        end
    endgenerate

endmodule

`default_nettype wire
